#include "mapping/ray_ranges.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// Tiles first..last along one image axis.
struct TileSpan {
    int first, last;
};

// The tiles that a ball's image touches along one axis. `c` is the ball's centre along it, z its
// depth.
TileSpan SpanOfBall(float c, float z, float radius, float focal, float centre, int tiles) {
    const float near_z = z - radius, far_z = z + radius;
    if (near_z < 0.01f) return {0, tiles - 1};  // too near to bound its image
    const float low = c - radius, high = c + radius;
    const float from = low / (low < 0 ? near_z : far_z) * focal + centre - 1;
    const float to = high / (high > 0 ? near_z : far_z) * focal + centre + 1;
    constexpr float kTile = RayRanges::kTilePx;
    const auto tile = [&](float pixel) {
        return static_cast<int>(
            std::floor(std::clamp(pixel / kTile, -1.0f, static_cast<float>(tiles))));
    };
    return {std::max(tile(from), 0), std::min(tile(to), tiles - 1)};
}

struct RegionBox {
    Eigen::Vector3i low, high;  // both included
    std::int64_t count() const { return (high - low).cast<std::int64_t>().array().operator+(1).prod(); }
};

// Around the pyramid of what the camera sees up to a depth, half a block wider than it.
RegionBox RegionsInView(const BlockMap& map, const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                        double max_depth_m) {
    const double block_m = map.config().voxel_size_m * kBlockSide, region_m = block_m * BlockMap::kRegionBlocks;
    Eigen::AlignedBox3d box(T_world_camera.translation());
    for (const double x : {-1.0, static_cast<double>(camera.width)})
        for (const double y : {-1.0, static_cast<double>(camera.height)}) {
            const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
            box.extend(T_world_camera * (ray * (max_depth_m + block_m)));
        }
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(block_m);
    return {((box.min() - margin) / region_m).array().floor().cast<int>(),
            ((box.max() + margin) / region_m).array().floor().cast<int>()};
}

}  // namespace

void RayRanges::Build(const BlockMap& map, const PinholeCamera& camera,
                      const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                      float max_depth_m) {
    width = (camera.width + kTilePx - 1) / kTilePx;
    height = (camera.height + kTilePx - 1) / kTilePx;
    ranges.assign(static_cast<std::size_t>(width * height), {max_depth_m, min_depth_m});
    const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
    const double voxel_m = map.config().voxel_size_m;
    // The cells of a block reach one voxel beyond its voxels.
    const float radius = static_cast<float>(0.5 * kBlockSide * voxel_m * std::sqrt(3.0));
    const auto add_block = [&](BlockId id) {
        const BlockCoord b = map.coord(id);
        const Eigen::Vector3d middle =
            (Eigen::Vector3d(b.x, b.y, b.z).array() + 0.5) * kBlockSide * voxel_m;
        const Eigen::Vector3f c = (T_camera_world * middle).cast<float>();
        if (c.z() + radius < min_depth_m || c.z() - radius > max_depth_m) return;
        const TileSpan columns = SpanOfBall(c.x(), c.z(), radius, static_cast<float>(camera.fx),
                                            static_cast<float>(camera.cx), width);
        const TileSpan lines = SpanOfBall(c.y(), c.z(), radius, static_cast<float>(camera.fy),
                                          static_cast<float>(camera.cy), height);
        const float first = std::max(c.z() - radius, min_depth_m);
        const float last = std::min(c.z() + radius, max_depth_m);
        for (int y = lines.first; y <= lines.last; ++y)
            for (int x = columns.first; x <= columns.last; ++x) {
                Range& range = ranges[static_cast<std::size_t>(y * width + x)];
                range.first_m = std::min(range.first_m, first);
                range.last_m = std::max(range.last_m, last);
            }
    };

    // Whichever is less to look at: the regions that the view's pyramid may touch, or all blocks.
    const RegionBox box = RegionsInView(map, camera, T_world_camera, max_depth_m);
    if (box.count() < map.size()) {
        for (int z = box.low.z(); z <= box.high.z(); ++z)
            for (int y = box.low.y(); y <= box.high.y(); ++y)
                for (int x = box.low.x(); x <= box.high.x(); ++x)
                    for (const BlockId id : map.BlocksInRegion({x, y, z})) add_block(id);
    } else {
        for (BlockId id = 1; id < map.size(); ++id)
            if (!map.IsFree(id)) add_block(id);
    }
}

}  // namespace tessera
