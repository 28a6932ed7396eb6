// Selects the blocks to allocate for one depth measurement ([B14] III-C1). Host-device: plain
// functions on plain types, shared by the CPU code and CUDA.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/scalar_ops.h"
#include "mapping/field_sampler.h"
#include "mapping/truncation_band.h"
#include "mapping/voxel.h"

namespace tessera {

// An axis-aligned box in the world frame. If bounded, the map does not grow outside it.
struct WorldBox {
    bool bounded;
    double low_m[3], high_m[3];
};

// Whether the block overlaps the box. Always true if the box is unbounded.
TESSERA_HD bool Meets(const WorldBox& box, const BlockCoord& block, double block_m) {
    const std::int32_t index[3] = {block.x, block.y, block.z};
    bool meets = true;
    for (int i = 0; i < 3; ++i)
        meets &= index[i] * block_m < box.high_m[i] && (index[i] + 1) * block_m > box.low_m[i];
    return !box.bounded || meets;
}

// Walks the ray of every step-th pixel through the truncation band around its measured depth.
struct BandWalk {
    const float* depth_m;  // 0 = none
    std::int32_t width, height;
    std::int32_t step;  // ray spacing in pixels, along both image axes
    double fx, fy, cx, cy;
    // p_world [blocks] = block + part + rotation * p_camera [m]. The separate integer part keeps
    // single precision accurate far from the origin.
    float rotation[9];
    float part[3];
    std::int32_t block[3];
    float block_m;
    TruncationBand band;

    TESSERA_HD_MEMBER std::int32_t columns() const { return (width + step - 1) / step; }
    TESSERA_HD_MEMBER std::int32_t rows() const { return (height + step - 1) / step; }
};

// True if at least two of the four neighbours are within 5 %. An isolated measurement is noise and
// not worth any memory.
TESSERA_HD bool HasSupport(const BandWalk& walk, std::int32_t x, std::int32_t y) {
    const std::int32_t reach = (walk.step > 2 ? walk.step : 2) / 2;
    const float* row = walk.depth_m + static_cast<std::int64_t>(y) * walk.width;
    const float z = row[x], tolerance = 0.05f * z;
    const std::int32_t left = x > reach ? x - reach : 0,
                       right = x + reach < walk.width ? x + reach : walk.width - 1;
    const std::int32_t top = y > reach ? y - reach : 0,
                       bottom = y + reach < walk.height ? y + reach : walk.height - 1;
    const float around[4] = {row[left], row[right],
                             walk.depth_m[static_cast<std::int64_t>(top) * walk.width + x],
                             walk.depth_m[static_cast<std::int64_t>(bottom) * walk.width + x]};
    int near = 0;
    for (const float other : around) near += abs(other - z) < tolerance;
    return near >= 2;
}

// Calls visit(block) for every block that the ray of pixel (step * column, step * row) crosses
// within the band. A block may be visited more than once. A margin of 1.5 voxels around the ray
// adds neighbouring blocks that the tracker's interpolation needs.
template <class Visit>
TESSERA_HD void WalkRay(const BandWalk& walk, std::int32_t column, std::int32_t row,
                        const Visit& visit) {
    constexpr float kMargin = 1.5f / kBlockSide;
    const std::int32_t x = column * walk.step, y = row * walk.step;
    const float z = walk.depth_m[static_cast<std::int64_t>(y) * walk.width + x];
    if (z <= 0 || !HasSupport(walk, x, y)) return;
    const auto ray_x = static_cast<float>((x - walk.cx) / walk.fx),
               ray_y = static_cast<float>((y - walk.cy) / walk.fy);
    const float band_m = walk.band.At(z);
    // Steps of half a block at most.
    const auto steps = static_cast<int>(std::ceil(4.0f * band_m / walk.block_m));
    for (int i = 0; i <= steps; ++i) {
        const float along =
            z + band_m * (2.0f * static_cast<float>(i) / static_cast<float>(steps) - 1.0f);
        const float p_camera[3] = {ray_x * along, ray_y * along, along};
        std::int32_t low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            const float* r = walk.rotation + 3 * k;
            const float p =
                r[0] * p_camera[0] + r[1] * p_camera[1] + r[2] * p_camera[2] + walk.part[k];
            low[k] = Floor(p - kMargin) + walk.block[k];
            high[k] = Floor(p + kMargin) + walk.block[k];
        }
        for (std::int32_t bz = low[2]; bz <= high[2]; ++bz)
            for (std::int32_t by = low[1]; by <= high[1]; ++by)
                for (std::int32_t bx = low[0]; bx <= high[0]; ++bx) visit(BlockCoord{bx, by, bz});
    }
}

}  // namespace tessera
