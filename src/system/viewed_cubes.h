// Which cubes of a map (scan/cube.h) a camera may see, and which are far enough away to be removed
// from memory.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <utility>
#include <vector>

#include "scan/cube.h"
#include "system/pipeline_config.h"

namespace tessera {

// Cubes this near to the camera's view stay in memory. Otherwise they would be removed and loaded
// again and again.
inline constexpr double kKeepAround_m = 1.25;
inline constexpr double kRefill = 0.9;  // a release goes down to this fraction of the limit

// A value; thread-safe.
class ViewedCubes {
  public:
    ViewedCubes(const PipelineConfig& config, const PinholeCamera& camera);

    // Distance from a cube to the hemisphere that tracking and fusion at this pose may read or
    // write. At most 0: the cube intersects it.
    double Outside_m(const Eigen::Isometry3d& T_world_camera, const BlockCoord& cube) const;
    // The first and the last cube, along each axis, of a box around all cubes with Outside_m <=
    // `further_m`.
    std::pair<BlockCoord, BlockCoord> Around(const Eigen::Isometry3d& T_world_camera,
                                             double further_m) const;

  private:
    const double cube_m_;
    const double margin_m_;  // around what the camera sees
    const double reach_m_;   // from the camera, including the margin
};

// The blocks of a map, grouped by cube. Owner thread only.
class ResidentCubes {
  public:
    struct Cube {
        double outside_m = 0;
        BlockCoord cube;
        std::size_t first = 0, last = 0;  // range of its blocks
    };

    // Collects all blocks of the current map.
    void Gather(const BlockMap& map);
    // The cubes that may be removed, farthest first.
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
