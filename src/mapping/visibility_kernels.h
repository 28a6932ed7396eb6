// Whether a depth image may change a block. Host-device: plain functions on plain types, shared by
// the CPU code and CUDA.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/scalar_ops.h"
#include "mapping/truncation_band.h"
#include "mapping/voxel.h"

namespace tessera {

// The farthest valid depth of each 16 x 16 pixel tile, 0 where a tile has none.
inline constexpr int kDepthTilePx = 16;
struct DepthTileView {
    const float* farthest_m;
    std::int32_t width, height;  // tiles
};

// Farthest depth of the pixels of an image row in one column of tiles. A tile's depth is the
// farthest of its rows.
TESSERA_HD float FarthestOfTileRow(const float* row, std::int32_t width, std::int32_t tile_x) {
    float farthest = 0.0f;
    for (std::int32_t x = tile_x * kDepthTilePx; x < (tile_x + 1) * kDepthTilePx && x < width; ++x)
        farthest = max(farthest, row[x]);
    return farthest;
}

// The view frustum: four planes through the camera centre, in the camera frame.
struct ViewCone {
    double fx, fy, cx, cy;
    double rotation[9], translation[3];  // T_camera_world, row-major
    double planes[4][3];                 // inward unit normals
    double far_m;
    double voxel_size_m;
    TruncationBand band;
    RegionBox regions;  // around the frustum

    TESSERA_HD_MEMBER void ToCamera(const double* p_world, double* p_camera) const {
        for (int i = 0; i < 3; ++i) {
            const double* r = rotation + 3 * i;
            p_camera[i] =
                r[0] * p_world[0] + r[1] * p_world[1] + r[2] * p_world[2] + translation[i];
        }
    }

    // Whether a ball in the camera frame may intersect the frustum.
    TESSERA_HD_MEMBER bool MayContain(const double* centre, double radius_m) const {
        bool inside = centre[2] >= -radius_m && centre[2] <= far_m + radius_m;
        for (const auto& n : planes)
            inside &= n[0] * centre[0] + n[1] * centre[1] + n[2] * centre[2] > -radius_m;
        return inside;
    }
};

// Whether a ball in the camera frame may contain voxels in front of, or just behind, the measured
// depth of the tiles that it covers.
TESSERA_HD bool MayChange(const DepthTileView& tiles, const ViewCone& cone, const double* c,
                          double radius_m) {
    if (c[2] < 2 * radius_m) return true;  // too near to bound its image
    // Bounds of the ball's image, in units of focal lengths.
    const double reach = radius_m / (c[2] - radius_m);
    const double u = c[0] / c[2] * cone.fx + cone.cx, v = c[1] / c[2] * cone.fy + cone.cy;
    const double slant = 1.0 + std::sqrt(c[0] * c[0] + c[1] * c[1]) / c[2];
    const double ru = reach * slant * cone.fx + 1, rv = reach * slant * cone.fy + 1;
    const auto tile = [](double pixel, std::int32_t count) {
        const double at = std::floor(pixel / kDepthTilePx);
        return at < 0 ? 0 : (at < count ? static_cast<std::int32_t>(at) : count - 1);
    };
    const double near_z = c[2] - radius_m;
    const std::int32_t last_x = tile(u + ru, tiles.width), last_y = tile(v + rv, tiles.height);
    for (std::int32_t ty = tile(v - rv, tiles.height); ty <= last_y; ++ty)
        for (std::int32_t tx = tile(u - ru, tiles.width); tx <= last_x; ++tx) {
            const float farthest_m = tiles.farthest_m[ty * tiles.width + tx];
            if (farthest_m + cone.band.At(farthest_m) > near_z) return true;
        }
    return false;
}

// Whether the block's voxels may change, judged by the ball around their centres.
TESSERA_HD bool MayChangeBlock(const DepthTileView& tiles, const ViewCone& cone,
                               const BlockCoord& block) {
    const double p_world[3] = {(block.x * kBlockSide + 3.5) * cone.voxel_size_m,
                               (block.y * kBlockSide + 3.5) * cone.voxel_size_m,
                               (block.z * kBlockSide + 3.5) * cone.voxel_size_m};
    const double radius_m = 3.5 * 1.7321 * cone.voxel_size_m;
    double centre[3];
    cone.ToCamera(p_world, centre);
    return cone.MayContain(centre, radius_m) && MayChange(tiles, cone, centre, radius_m);
}

}  // namespace tessera
