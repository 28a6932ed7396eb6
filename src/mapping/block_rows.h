// Reading the map in vectors: which block each lane's point lies in, and where the eight voxels around it are. Included
// only by vector sources. The scalar code is field_sampler.h. `Map` is BlockMap::View or any struct with the same plain
// pointers.
#pragma once

#include <algorithm>

#include "core/vector_types.h"
#include "mapping/voxel.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {

// BlockHash of voxel.h for every lane.
[[gnu::always_inline]] inline Int HashBlocks(const Int& x, const Int& y, const Int& z) {
    Bits h = (AsBits(x) * Bits(73856093u)) ^ (AsBits(y) * Bits(19349669u)) ^ (AsBits(z) * Bits(83492791u));
    h = h ^ (h >> 15);
    return AsInt(((h * Bits(2654435769u)) >> 4) ^ h);
}

// BlockMap::Find for every pending lane; kUnknownBlock elsewhere. x, y, z: the block's coordinate in the world.
template <class Map>
[[gnu::always_inline]] inline Int FindBlocks(const Map& map, const Int& x, const Int& y, const Int& z,
                                             RealMask pending) {
    const Int mask(static_cast<std::int32_t>(map.table_mask));
    Int slot = HashBlocks(x, y, z) & mask;
    Int found(0);
    while (xsimd::any(pending)) {
        const Int id = Gather(map.table, slot);
        const Int at = id << 2;
        const RealMask match = AsRealMask((Gather(map.coords, at) == x) & (Gather(map.coords + 1, at) == y) &
                                          (Gather(map.coords + 2, at) == z));
        found = Select(pending & match, id, found);
        pending = pending & ~match & AsRealMask(id != Int(0));
        slot = (slot + Int(1)) & mask;
    }
    return found;
}

// Indices into the map's layers of the corners of cells: index[c] is the corner at offsets (x, y, z) = bits 0, 1, 2 of
// c. `voxel`: the lowest corner; only its three low bits count, as it lies in `block`.
template <class Map>
[[gnu::always_inline]] inline void CornerVoxels(const Map& map, const Int& block, const Int* voxel, Int* index) {
    const Int seven(7);
    const Int x0 = voxel[0] & seven, y0 = voxel[1] & seven, z0 = voxel[2] & seven;
    const Int x1 = x0 + Int(1), y1 = y0 + Int(1), z1 = z0 + Int(1);
    // Where the upper corner leaves the block: its neighbour's slot bits, else 0.
    const Int over_x = x1 >> 3, over_y = y1 >> 3, over_z = z1 >> 3;
    const Int in_x[2] = {x0, x1 & seven};
    const Int in_y[2] = {y0 << 3, (y1 & seven) << 3};
    const Int in_z[2] = {z0 << 6, (z1 & seven) << 6};
    const bool inside = !xsimd::any(AsRealMask((over_x | over_y | over_z) != Int(0)));
    for (int c = 0; c < 8; ++c) {
        const int bx = c & 1, by = c >> 1 & 1, bz = c >> 2;
        Int owner = block;
        if (!inside && c != 0) {
            const Int slot = (bx ? over_x : Int(0)) | (by ? over_y << 1 : Int(0)) | (bz ? over_z << 2 : Int(0));
            owner = Gather(map.neighbours, (block << 3) + slot);
        }
        index[c] = (owner << 9) + in_x[bx] + in_y[by] + in_z[bz];
    }
}

// The blocks met lately, absent ones too, in front of the map's hash, which takes far longer: for rays, whose
// neighbours meet the same blocks.
class BlockCache {
  public:
    // Blocks must lie within so many of the origin along each axis.
    static constexpr std::int32_t kReachBlocks = 4096;

    BlockCache() { std::fill_n(keys_, kSlots, kEmpty); }

    // The ids of the wanted lanes' blocks, any ids of the map elsewhere. `block`: counted from map.origin_block, the
    // same in every call.
    template <class Map>
    [[gnu::always_inline]] Int Find(const Map& map, const Int* block, const RealMask& wanted) {
        Int slot(0), key(0);
        for (int k = 0; k < 3; ++k) {
            slot = slot | (block[k] & Int((1 << kSlotBits) - 1)) << (kSlotBits * k);
            key = key | ((block[k] >> kSlotBits) & Int((1 << kKeyBits) - 1)) << (kKeyBits * k);
        }
        const Int id = Gather(ids_, slot);
        const RealMask missing = wanted & AsRealMask(Gather(keys_, slot) != key);
        return xsimd::any(missing) ? Select(missing, Add(map, block, slot, key, missing), id) : id;
    }

  private:
    static constexpr int kSlotBits = 3, kKeyBits = 10;  // of each axis
    static constexpr int kSlots = 1 << (3 * kSlotBits);
    static constexpr std::int32_t kEmpty = -1;
    static_assert(2 * kReachBlocks == 1 << (kSlotBits + kKeyBits), "else two blocks would share a key");

    template <class Map>
    [[gnu::noinline]] Int Add(const Map& map, const Int* block, const Int& slot, const Int& key, const RealMask& missing) {
        const Int found = FindBlocks(map, block[0] + Int(map.origin_block[0]), block[1] + Int(map.origin_block[1]),
                                     block[2] + Int(map.origin_block[2]), missing);
        alignas(64) std::int32_t slots[kLanes], keys[kLanes], ids[kLanes], wanted[kLanes];
        slot.store_aligned(slots);
        key.store_aligned(keys);
        found.store_aligned(ids);
        Select(missing, Int(1), Int(0)).store_aligned(wanted);
        for (int i = 0; i < kLanes; ++i) {
            if (!wanted[i]) continue;
            keys_[slots[i]] = keys[i];
            ids_[slots[i]] = ids[i];
        }
        return found;
    }

    alignas(64) std::int32_t keys_[kSlots], ids_[kSlots] = {};
};

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
