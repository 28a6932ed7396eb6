#include "mapping/visible_blocks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace tessera {
namespace {

// Calls `visit` with the blocks of each region that may meet the cone, or with each one of them.
template <class Visit>
void ForEachRegion(const ViewCone& cone, const BlockMap& map, const Visit& visit) {
    const double region_m = map.config().voxel_size_m * kBlockSide * kRegionBlocks;
    const auto may_meet = [&](const BlockCoord& region) {
        const double p_world[3] = {(region.x + 0.5) * region_m, (region.y + 0.5) * region_m,
                                   (region.z + 0.5) * region_m};
        double centre[3];
        cone.ToCamera(p_world, centre);
        return cone.MayContain(centre, 0.8661 * region_m);
    };
    // Use whichever is fewer: the regions around the frustum, or all blocks.
    if (cone.regions.Count() >= map.size()) {
        for (BlockId id = 1; id < map.size(); ++id) {
            if (map.IsFree(id)) continue;
            const BlockCoord region = RegionOf(map.coord(id));
            if (cone.regions.Has(region) && may_meet(region))
                visit(std::span<const BlockId>(&id, 1));
        }
        return;
    }
    for (int z = cone.regions.first[2]; z <= cone.regions.last[2]; ++z)
        for (int y = cone.regions.first[1]; y <= cone.regions.last[1]; ++y)
            for (int x = cone.regions.first[0]; x <= cone.regions.last[0]; ++x)
                if (may_meet({x, y, z})) visit(map.BlocksInRegion({x, y, z}));
}

}  // namespace

void DepthTiles::Build(const DepthImage& depth) {
    width = (depth.width() + kDepthTilePx - 1) / kDepthTilePx;
    height = (depth.height() + kDepthTilePx - 1) / kDepthTilePx;
    farthest_m.resize(static_cast<std::size_t>(width * height));
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            float& farthest = farthest_m[static_cast<std::size_t>(y * width + x)] = 0;
            for (int row = y * kDepthTilePx; row < std::min((y + 1) * kDepthTilePx, depth.height());
                 ++row)
                farthest = std::max(farthest, FarthestOfTileRow(depth.row(row), depth.width(), x));
        }
    });
}

ViewCone MakeViewCone(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                      float farthest_m, const BlockMap::Config& map) {
    const TruncationBand band = map.band();
    const double far_m = farthest_m + band.At(farthest_m);
    ViewCone cone{camera.fx, camera.fy, camera.cx,        camera.cy, {}, {},
                  {},        far_m,     map.voxel_size_m, band,      {}};
    const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) cone.rotation[3 * i + j] = T_camera_world.linear()(i, j);
        cone.translation[i] = T_camera_world.translation()[i];
    }
    const double left = (-0.5 - camera.cx) / camera.fx,
                 right = (camera.width - 0.5 - camera.cx) / camera.fx;
    const double top = (-0.5 - camera.cy) / camera.fy,
                 bottom = (camera.height - 0.5 - camera.cy) / camera.fy;
    const Eigen::Vector3d inward[4] = {
        {1, 0, -left}, {-1, 0, right}, {0, 1, -top}, {0, -1, bottom}};
    for (int plane = 0; plane < 4; ++plane)
        for (int i = 0; i < 3; ++i) cone.planes[plane][i] = inward[plane].normalized()[i];

    // Regions in the box around the frustum.
    const double region_m = map.voxel_size_m * kBlockSide * kRegionBlocks;
    Eigen::Vector3d low = T_world_camera.translation(), high = low;
    for (const double u : {-0.5, camera.width - 0.5})
        for (const double v : {-0.5, camera.height - 0.5}) {
            const Eigen::Vector3d corner = T_world_camera * camera.Unproject(u, v, far_m);
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
    for (int i = 0; i < 3; ++i) {
        cone.regions.first[i] = static_cast<std::int32_t>(std::floor(low[i] / region_m)) - 1;
        cone.regions.last[i] = static_cast<std::int32_t>(std::floor(high[i] / region_m));
    }
    return cone;
}

bool MaySee(const BlockMap& map, const PinholeCamera& camera,
            const Eigen::Isometry3d& T_world_camera, float farthest_m) {
    bool any = false;
    ForEachRegion(MakeViewCone(camera, T_world_camera, farthest_m, map.config()), map,
                  [&](std::span<const BlockId> blocks) { any |= !blocks.empty(); });
    return any;
}

const std::vector<BlockId>& VisibleBlocks::Find(const BlockMap& map, const PinholeCamera& camera,
                                                const Eigen::Isometry3d& T_world_camera,
                                                const DepthImage& depth_m, float farthest_m) {
    tiles_.Build(depth_m);
    const ViewCone cone = MakeViewCone(camera, T_world_camera, farthest_m, map.config());
    candidates_.clear();
    ForEachRegion(cone, map, [&](std::span<const BlockId> blocks) {
        candidates_.insert(candidates_.end(), blocks.begin(), blocks.end());
    });

    keep_.resize(candidates_.size());
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, candidates_.size(), 512), [&](const auto& range) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
                keep_[i] = MayChangeBlock(tiles_.view(), cone, map.coord(candidates_[i]));
        });
    visible_.clear();
    for (std::size_t i = 0; i < candidates_.size(); ++i)
        if (keep_[i]) visible_.push_back(candidates_[i]);
    std::sort(visible_.begin(), visible_.end());
    return visible_;
}

}  // namespace tessera
