#include "mapping/ray_ranges.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// The regions that the view pyramid up to a depth may touch, with a margin of one block.
RegionBox RegionsInView(const BlockMap& map, const PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera, double max_depth_m) {
    const double block_m = map.config().voxel_size_m * kBlockSide,
                 region_m = block_m * kRegionBlocks;
    Eigen::AlignedBox3d box(T_world_camera.translation());
    for (const double x : {-1.0, static_cast<double>(camera.width)})
        for (const double y : {-1.0, static_cast<double>(camera.height)}) {
            const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy,
                                      1.0);
            box.extend(T_world_camera * (ray * (max_depth_m + block_m)));
        }
    RegionBox regions;
    for (int i = 0; i < 3; ++i) {
        regions.first[i] =
            static_cast<std::int32_t>(std::floor((box.min()[i] - block_m) / region_m));
        regions.last[i] =
            static_cast<std::int32_t>(std::floor((box.max()[i] + block_m) / region_m));
    }
    return regions;
}

}  // namespace

RangeArguments MakeRangeArguments(const BlockMap& map, const PinholeCamera& camera,
                                  const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                                  float max_depth_m) {
    RangeArguments a{};
    const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) a.rotation[3 * i + j] = T_camera_world.linear()(i, j);
        a.translation[i] = T_camera_world.translation()[i];
    }
    a.voxel_size_m = map.config().voxel_size_m;
    // The cells of a block reach one voxel beyond its voxels.
    a.radius_m = static_cast<float>(0.5 * kBlockSide * a.voxel_size_m * std::sqrt(3.0));
    a.fx = static_cast<float>(camera.fx);
    a.fy = static_cast<float>(camera.fy);
    a.cx = static_cast<float>(camera.cx);
    a.cy = static_cast<float>(camera.cy);
    a.min_depth_m = min_depth_m;
    a.max_depth_m = max_depth_m;
    a.width = (camera.width + kRayTilePx - 1) / kRayTilePx;
    a.height = (camera.height + kRayTilePx - 1) / kRayTilePx;
    // Use whichever is fewer: the regions that the view pyramid may touch, or all blocks.
    a.regions = RegionsInView(map, camera, T_world_camera, max_depth_m);
    a.all_regions = a.regions.Count() >= map.size();
    return a;
}

void RayRanges::Build(const BlockMap& map, const PinholeCamera& camera,
                      const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                      float max_depth_m) {
    const RangeArguments a =
        MakeRangeArguments(map, camera, T_world_camera, min_depth_m, max_depth_m);
    width = a.width;
    height = a.height;
    ranges.assign(static_cast<std::size_t>(width * height), {max_depth_m, min_depth_m});
    const auto add_block = [&](BlockId id) {
        BlockReach reach;
        if (!ReachOf(a, map.coord(id), reach)) return;
        for (int y = reach.lines.first; y <= reach.lines.last; ++y)
            for (int x = reach.columns.first; x <= reach.columns.last; ++x) {
                RayRange& range = ranges[static_cast<std::size_t>(y * width + x)];
                range.first_m = std::min(range.first_m, reach.range.first_m);
                range.last_m = std::max(range.last_m, reach.range.last_m);
            }
    };
    if (a.all_regions) {
        for (BlockId id = 1; id < map.size(); ++id)
            if (!map.IsFree(id)) add_block(id);
        return;
    }
    for (int z = a.regions.first[2]; z <= a.regions.last[2]; ++z)
        for (int y = a.regions.first[1]; y <= a.regions.last[1]; ++y)
            for (int x = a.regions.first[0]; x <= a.regions.last[0]; ++x)
                for (const BlockId id : map.BlocksInRegion({x, y, z})) add_block(id);
}

}  // namespace tessera
