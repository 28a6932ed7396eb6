// Which cubes of a map (scan/cube.h) a camera may see, and which lie so far from it that they need
// not be in memory.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <utility>
#include <vector>

#include "scan/cube.h"
#include "system/pipeline_config.h"

namespace tessera {

// Outside of what a camera may see cubes stay: else they would come and go.
inline constexpr double kKeepAround_m = 1.25;
inline constexpr double kRefill = 0.9;  // of a limit, that a release goes down to

// A value; thread-safe.
class ViewedCubes {
  public:
    ViewedCubes(const PipelineConfig& config, const PinholeCamera& camera);

    // How far a cube is from the half ball that tracking and fusion from there may read or write;
    // at most 0: it is in it.
    double Outside_m(const Eigen::Isometry3d& T_world_camera, const BlockCoord& cube) const;
    // The first and the last cube, along each axis, of a box around all that are at most so far
    // outside.
    std::pair<BlockCoord, BlockCoord> Around(const Eigen::Isometry3d& T_world_camera,
                                             double further_m) const;

  private:
    const double cube_m_;
    const double margin_m_;  // around what the camera sees
    const double reach_m_;   // from the camera, the margin included
};

// The blocks of a map by cube. Owner thread only.
class ResidentCubes {
  public:
    struct Cube {
        double outside_m = 0;
        BlockCoord cube;
        std::size_t first = 0, last = 0;  // of its blocks
    };

    // All blocks of the map as it is now.
    void Gather(const BlockMap& map);
    // The cubes that may leave, the farthest first.
    std::vector<Cube> Farthest(const ViewedCubes& viewed,
                               const Eigen::Isometry3d& T_world_camera) const;
    // By increasing coordinate.
    std::vector<Cube> All() const;
    std::span<const BlockId> blocks(const Cube& cube) const {
        return std::span(ids_).subspan(cube.first, cube.last - cube.first);
    }

  private:
    std::vector<std::pair<BlockCoord, BlockId>> blocks_;
    std::vector<BlockId> ids_;
};

}  // namespace tessera
