#include "system/viewed_cubes.h"

#include <algorithm>
#include <functional>

namespace tessera {
namespace {

// Fusion reads and writes this far around the measured surface, and tracking beyond that.
double MarginOf(const BlockMap::Config& map) {
    constexpr double kPoses_m = 0.3;  // tracking tries poses around the one it finds
    return map.range_m() + 2 * kBlockSide * map.voxel_size_m + kPoses_m;
}

// The camera's measuring range.
double RangeOf(const PipelineConfig& config, const PinholeCamera& camera) {
    double corner_m = 0;
    for (const double u : {-0.5, camera.width - 0.5})
        for (const double v : {-0.5, camera.height - 0.5})
            corner_m = std::max(corner_m, camera.Unproject(u, v, config.frame.max_depth_m).norm());
    return corner_m;
}

}  // namespace

ViewedCubes::ViewedCubes(const PipelineConfig& config, const PinholeCamera& camera)
    : cube_m_(kCubeBlocks * kBlockSide * config.map.voxel_size_m),
      margin_m_(MarginOf(config.map)),
      reach_m_(RangeOf(config, camera) + margin_m_) {}

double ViewedCubes::Outside_m(const Eigen::Isometry3d& T_world_camera,
                              const BlockCoord& cube) const {
    const Eigen::Vector3d camera = T_world_camera.translation();
    const Eigen::Vector3d low = Eigen::Vector3d(cube.x, cube.y, cube.z) * cube_m_;
    const Eigen::Vector3d high = low.array() + cube_m_;
    const double away_m = (camera - camera.cwiseMax(low).cwiseMin(high)).norm();
    const double ahead_m =
        T_world_camera.linear().col(2).dot(0.5 * (low + high) - camera) + 0.866 * cube_m_;
    return std::max(away_m - reach_m_, -ahead_m - margin_m_);
}

std::pair<BlockCoord, BlockCoord> ViewedCubes::Around(const Eigen::Isometry3d& T_world_camera,
                                                      double further_m) const {
    constexpr double kLimit = kBlockLimit / kCubeBlocks;
    const Eigen::Array3d camera = T_world_camera.translation();
    const auto cube_of = [&](double offset_m) -> BlockCoord {
        const Eigen::Array3i cube =
            ((camera + offset_m) / cube_m_).floor().max(-kLimit).min(kLimit - 1).cast<int>();
        return {cube.x(), cube.y(), cube.z()};
    };
    return {cube_of(-reach_m_ - further_m), cube_of(reach_m_ + further_m)};
}

void ResidentCubes::Gather(const BlockMap& map) {
    blocks_.clear();
    ids_.clear();
    for (BlockId id = 1; id < map.size(); ++id)
        if (!map.IsFree(id)) blocks_.emplace_back(CubeOf(map.coord(id)), id);
    std::ranges::sort(blocks_);
    for (const auto& [cube, id] : blocks_) ids_.push_back(id);
}

std::vector<ResidentCubes::Cube> ResidentCubes::All() const {
    std::vector<Cube> cubes;
    for (std::size_t first = 0, last = 0; first < blocks_.size(); first = last) {
        while (last < blocks_.size() && blocks_[last].first == blocks_[first].first) ++last;
        cubes.push_back({0, blocks_[first].first, first, last});
    }
    return cubes;
}

std::vector<ResidentCubes::Cube> ResidentCubes::Farthest(
    const ViewedCubes& viewed, const Eigen::Isometry3d& T_world_camera) const {
    std::vector<Cube> cubes = All();
    for (Cube& cube : cubes) cube.outside_m = viewed.Outside_m(T_world_camera, cube.cube);
    std::erase_if(cubes, [](const Cube& cube) { return cube.outside_m <= kKeepAround_m; });
    std::ranges::stable_sort(cubes, std::greater(), &Cube::outside_m);
    return cubes;
}

}  // namespace tessera
