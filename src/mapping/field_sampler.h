// Samples the map's field at any point: distance and intensity with their analytic gradients.
// Scalar, host-device. The SIMD kernels use the same formula (trilinear.h). `View` is BlockMapView
// or any struct with the same plain pointers.
//
// One look-up finds the block of a cell's lowest corner. The other seven corners lie in that block
// or in its positive neighbours, which View::neighbours lists. The position of corner c is
//     block = neighbours[8 * base + slot], slot = which of (x, y, z) + (bits 0, 1, 2 of c) reach 8,
//     voxel = 512 * block + (x & 7) + 8 (y & 7) + 64 (z & 7).
// Absent blocks resolve to block 0, whose voxels are unknown, so there is no branch.
#pragma once

#include <cstdint>

#include "mapping/trilinear.h"
#include "mapping/voxel.h"

namespace tessera {

// The eight voxels around a point.
struct FieldCell {
    std::int32_t block;    // of the lowest corner; 0 if the map does not have it
    std::int32_t x, y, z;  // lowest corner within its block, 0 to 7
    float fx, fy, fz;      // the point relative to the lowest corner, [0, 1) voxels
};

struct FieldSample {
    bool has_distance;                  // all eight corners have one
    bool has_intensity;                 // likewise; implies has_distance
    ValueAndGradient<float> distance;   // metres; per metre
    ValueAndGradient<float> intensity;  // [0, 1]; per metre
};

// Looks up a block's id in the map's hash; 0 if absent.
template <class View>
TESSERA_HD std::int32_t FindBlock(const View& map, std::int32_t x, std::int32_t y, std::int32_t z) {
    for (std::uint32_t slot = BlockHash(x, y, z) & map.table_mask;;
         slot = (slot + 1) & map.table_mask) {
        const std::int32_t id = map.table[slot];
        const std::int32_t* c = map.coords + 4 * static_cast<std::int64_t>(id);
        if (id == 0 || (c[0] == x && c[1] == y && c[2] == z)) return id;
    }
}

// Largest integer not above v; |v| < 2^31.
TESSERA_HD std::int32_t Floor(float v) {
    const std::int32_t i = static_cast<std::int32_t>(v);
    return i - (static_cast<float>(i) > v ? 1 : 0);
}

// Points are in voxels relative to voxel (0, 0, 0) of `origin`, a nearby block. Floats then stay
// accurate far from the world's origin. Points must stay within 2^20 voxels of `origin`. The
// sampler remembers the last block, which neighbouring points usually share, so use one sampler per
// thread or ray.
template <class View>
class FieldSampler {
  public:
    TESSERA_HD_MEMBER FieldSampler(const View& map, const BlockCoord& origin)
        : map_(map), origin_(origin) {}

    TESSERA_HD_MEMBER FieldCell Locate(float px, float py, float pz) {
        const std::int32_t x = Floor(px), y = Floor(py), z = Floor(pz);
        const BlockCoord block{x >> 3, y >> 3, z >> 3};
        if (!(block == last_)) {
            last_ = block;
            last_id_ =
                FindBlock(map_, origin_.x + block.x, origin_.y + block.y, origin_.z + block.z);
        }
        return {last_id_,
                x & 7,
                y & 7,
                z & 7,
                px - static_cast<float>(x),
                py - static_cast<float>(y),
                pz - static_cast<float>(z)};
    }

    // voxel[c]: layer index of the corner at offset (x, y, z) = bits 0, 1, 2 of c.
    TESSERA_HD_MEMBER void Corners(const FieldCell& cell, std::int32_t* voxel) const {
        for (int c = 0; c < 8; ++c) {
            const int x = cell.x + (c & 1), y = cell.y + (c >> 1 & 1), z = cell.z + (c >> 2);
            const int slot = x >> 3 | y >> 3 << 1 | z >> 3 << 2;
            const std::int32_t block =
                map_.neighbours[8 * static_cast<std::int64_t>(cell.block) + slot];
            voxel[c] = kBlockVoxels * block + (x & 7) + 8 * (y & 7) + 64 * (z & 7);
        }
    }

    // The field word of the voxel nearest to the point.
    TESSERA_HD_MEMBER FieldWord Nearest(const FieldCell& cell) const {
        const int x = cell.x + (cell.fx >= 0.5f), y = cell.y + (cell.fy >= 0.5f),
                  z = cell.z + (cell.fz >= 0.5f);
        const int slot = x >> 3 | y >> 3 << 1 | z >> 3 << 2;
        const std::int32_t block =
            map_.neighbours[8 * static_cast<std::int64_t>(cell.block) + slot];
        return map_.field[kBlockVoxels * block + (x & 7) + 8 * (y & 7) + 64 * (z & 7)];
    }

    // kIntensity: also samples the intensity; otherwise has_intensity is false.
    template <bool kIntensity>
    TESSERA_HD_MEMBER FieldSample Sample(const FieldCell& cell) const {
        std::int32_t voxel[8];
        Corners(cell, voxel);
        float distance[8], intensity[8];
        FieldSample sample{true, kIntensity, {}, {}};
        for (int c = 0; c < 8; ++c) {
            const FieldWord word = map_.field[voxel[c]];
            sample.has_distance &= HasDistance(word);
            sample.has_intensity &= HasIntensity(word);
            distance[c] = FieldDistance(word);
            if (kIntensity) intensity[c] = FieldIntensity(word);
        }
        sample.has_intensity &= sample.has_distance;
        sample.distance = Scaled(Trilinear(distance, cell.fx, cell.fy, cell.fz), map_.band.most_m);
        if (kIntensity)
            sample.intensity = Scaled(Trilinear(intensity, cell.fx, cell.fy, cell.fz), 1.0f);
        return sample;
    }

  private:
    TESSERA_HD_MEMBER ValueAndGradient<float> Scaled(const ValueAndGradient<float>& v,
                                                     float unit) const {
        const float per_metre = unit / map_.voxel_size_m;
        return {v.value * unit, v.gx * per_metre, v.gy * per_metre, v.gz * per_metre};
    }

    View map_;
    BlockCoord origin_;
    BlockCoord last_{INT32_MAX, INT32_MAX, INT32_MAX};
    std::int32_t last_id_ = 0;
};

}  // namespace tessera
