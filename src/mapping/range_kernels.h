// Which tiles of a view a block may appear in, and between which depths. Host-device: plain
// functions on plain types, shared by RayRanges and CUDA.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/scalar_ops.h"
#include "mapping/voxel.h"

namespace tessera {

// Tiles have this many pixels per side and share one range.
inline constexpr int kRayTilePx = 8;

// Depths along z, metres; first > last if no block is in the way.
struct RayRange {
    float first_m, last_m;
};

// The view, and which blocks count.
struct RangeArguments {
    double rotation[9], translation[3];  // T_camera_world, row-major
    double voxel_size_m;
    float radius_m;  // of a ball around a block's cells
    float fx, fy, cx, cy;
    float min_depth_m, max_depth_m;
    std::int32_t width, height;  // tiles
    bool all_regions;            // if false, only blocks in `regions` count
    RegionBox regions;
};

// Tiles first..last along one image axis.
struct TileSpan {
    int first, last;
};

// The tiles that a ball's image touches along one axis. `c` is the ball centre's coordinate along
// that axis, z its depth.
TESSERA_HD TileSpan SpanOfBall(float c, float z, float radius, float focal, float centre,
                               int tiles) {
    const float near_z = z - radius, far_z = z + radius;
    if (near_z < 0.01f) return {0, tiles - 1};  // too near to bound its image
    const float low = c - radius, high = c + radius;
    const float from = low / (low < 0 ? near_z : far_z) * focal + centre - 1;
    const float to = high / (high > 0 ? near_z : far_z) * focal + centre + 1;
    const auto tile = [tiles](float pixel) {
        return static_cast<int>(
            std::floor(min(max(pixel / kRayTilePx, -1.0f), static_cast<float>(tiles))));
    };
    const int first = tile(from), last = tile(to);
    return {first > 0 ? first : 0, last < tiles ? last : tiles - 1};
}

// A block's contribution: extends the range of all tiles in these columns and lines by `range`.
struct BlockReach {
    TileSpan columns, lines;
    RayRange range;
};

// Returns false if the block does not lie between the view's two depths.
TESSERA_HD bool ReachOf(const RangeArguments& a, const BlockCoord& block, BlockReach& reach) {
    const double middle[3] = {(block.x + 0.5) * kBlockSide * a.voxel_size_m,
                              (block.y + 0.5) * kBlockSide * a.voxel_size_m,
                              (block.z + 0.5) * kBlockSide * a.voxel_size_m};
    float c[3];
    for (int i = 0; i < 3; ++i) {
        const double* r = a.rotation + 3 * i;
        c[i] = static_cast<float>(r[0] * middle[0] + r[1] * middle[1] + r[2] * middle[2] +
                                  a.translation[i]);
    }
    const float nearest = c[2] - a.radius_m, farthest = c[2] + a.radius_m;
    if (farthest < a.min_depth_m || nearest > a.max_depth_m) return false;
    reach.columns = SpanOfBall(c[0], c[2], a.radius_m, a.fx, a.cx, a.width);
    reach.lines = SpanOfBall(c[1], c[2], a.radius_m, a.fy, a.cy, a.height);
    reach.range = {max(nearest, a.min_depth_m), min(farthest, a.max_depth_m)};
    return true;
}

}  // namespace tessera
