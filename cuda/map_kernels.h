// The map's loop bodies (device_loops.h): one call per pixel, block or voxel.
#pragma once

#include "cuda/device_loops.h"
#include "cuda/device_map.h"

namespace tessera::TESSERA_DEVICE {

// Packs a coordinate into 64 bits that sort like BlockCoord. Never 0, which is an empty slot.
TESSERA_HD std::uint64_t KeyOf(const BlockCoord& c) {
    const auto part = [](std::int32_t v) { return static_cast<std::uint64_t>(v + kBlockLimit); };
    return std::uint64_t{1} << 63 | part(c.z) << 42 | part(c.y) << 21 | part(c.x);
}
TESSERA_HD BlockCoord CoordOf(std::uint64_t key) {
    const auto part = [key](int shift) {
        return static_cast<std::int32_t>(key >> shift & 0x1fffffu) - kBlockLimit;
    };
    return {part(0), part(21), part(42)};
}

TESSERA_HD std::int32_t Find(const DeviceMapView& map, const BlockCoord& c) {
    return FindBlock(map, c.x, c.y, c.z);
}

TESSERA_HD BlockCoord CoordAt(const DeviceMapView& map, std::int32_t id) {
    const std::int32_t* c = map.coords + 4 * static_cast<std::int64_t>(id);
    return {c[0], c[1], c[2]};
}

// A set of keys, filled by compare-and-swap, and the list of its entries. `missed` > 0 means that
// there was too little room; the caller then starts again with more.
struct KeySet {
    std::uint64_t* slots;
    std::uint32_t mask;
    std::uint64_t* list;
    std::int32_t* count;
    std::int32_t* missed;
    std::int32_t capacity;

    TESSERA_HD_MEMBER void Add(const BlockCoord& c) const {
        constexpr int kMaxProbes = 64;
        const std::uint64_t key = KeyOf(c);
        std::uint32_t slot = BlockHash(c.x, c.y, c.z) & mask;
        std::uint64_t before = 1;
        for (int probe = 0; probe < kMaxProbes && before != 0; ++probe, slot = (slot + 1) & mask) {
            before = AtomicSwapIf(slots + slot, std::uint64_t{0}, key);
            if (before == key) return;
        }
        const std::int32_t at = before == 0 ? AtomicAdd(count, 1) : capacity;
        if (at < capacity)
            list[at] = key;
        else
            AtomicAdd(missed, 1);
    }
};

// Per ray.
struct MarkWantedBlocks {
    BandWalk walk;
    WorldBox box;
    double block_m;
    DeviceMapView map;
    KeySet wanted;

    TESSERA_HD_MEMBER void operator()(int i) const {
        BlockCoord last{kBlockLimit, 0, 0};
        const std::int32_t columns = walk.columns();
        WalkRay(walk, i % columns, i / columns, [&](const BlockCoord& c) {
            if (c == last) return;
            last = c;
            if (Find(map, c) == 0 && InLimits(c) && Meets(box, c, block_m)) wanted.Add(c);
        });
    }
};

// Per voxel of the blocks from `first` on.
struct ClearVoxels {
    DeviceMapView map;
    std::int32_t first;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const std::int64_t at = static_cast<std::int64_t>(first) * kBlockVoxels + i;
        map.field[at] = kUnknownField;
        map.weight[at] = 0;
        map.colour[at] = kNoColour;
    }
};

// Per key: sets the coordinate, the number and the revision of its block.
struct PlaceBlocks {
    DeviceMapView map;
    std::int32_t first;
    const std::uint64_t* keys;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const std::int64_t id = first + i;
        const BlockCoord c = CoordOf(keys[i]);
        const std::int32_t coords[4] = {c.x, c.y, c.z, static_cast<std::int32_t>(id)};
        for (int k = 0; k < 4; ++k) map.coords[4 * id + k] = coords[k];
        map.revision[id] = 0;
    }
};

// Per block from `first` on. Which of several colliding slots a block gets may differ between runs;
// what look-ups find does not.
struct InsertIntoTable {
    DeviceMapView map;
    std::int32_t first;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const std::int32_t id = first + i;
        const BlockCoord c = CoordAt(map, id);
        std::uint32_t slot = BlockHash(c.x, c.y, c.z) & map.table_mask;
        while (AtomicSwapIf(map.table + slot, 0, id) != 0) slot = (slot + 1) & map.table_mask;
    }
};

// Per block from `first` on and slot of View::neighbours: enters the neighbour there, and the new
// block in an older one that has it as a neighbour. New blocks enter each other themselves.
struct LinkNeighbours {
    DeviceMapView map;
    std::int32_t first;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const std::int32_t id = first + i / 8, slot = i % 8;
        const std::int32_t dx = slot & 1, dy = slot >> 1 & 1, dz = slot >> 2;
        const BlockCoord c = CoordAt(map, id);
        map.neighbours[8 * static_cast<std::int64_t>(id) + slot] =
            Find(map, {c.x + dx, c.y + dy, c.z + dz});
        const std::int32_t before = Find(map, {c.x - dx, c.y - dy, c.z - dz});
        if (before != 0 && before < first)
            map.neighbours[8 * static_cast<std::int64_t>(before) + slot] = id;
    }
};

// Per block. The unknown block is never visible.
struct FlagVisible {
    DeviceMapView map;
    DepthTileView tiles;
    ViewCone cone;
    std::uint8_t* keep;

    TESSERA_HD_MEMBER void operator()(int id) const {
        const BlockCoord c = CoordAt(map, id);
        keep[id] = id != 0 && cone.regions.Has(RegionOf(c)) && MayChangeBlock(tiles, cone, c);
    }
};

// Per block.
struct FlagSince {
    DeviceMapView map;
    std::uint32_t first;
    std::uint8_t* keep;

    TESSERA_HD_MEMBER void operator()(int id) const {
        keep[id] = id != 0 && map.revision[id] >= first;
    }
};

// Per voxel of the listed blocks: packs the voxels for one copy to the host.
struct GatherVoxels {
    DeviceMapView map;
    const std::int32_t* ids;
    FieldWord* field;
    std::uint16_t* weight;
    ColourWord* colour;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const std::int64_t at =
            static_cast<std::int64_t>(ids[i / kBlockVoxels]) * kBlockVoxels + i % kBlockVoxels;
        field[i] = map.field[at];
        weight[i] = map.weight[at];
        colour[i] = map.colour[at];
    }
};

}  // namespace tessera::TESSERA_DEVICE
