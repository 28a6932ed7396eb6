// The depth range in which the rays of a view can meet blocks. Outside it they need not be walked.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "mapping/block_map.h"
#include "mapping/range_kernels.h"

namespace tessera {

// The arguments of ReachOf for a view of the map. Only blocks between the two depths count, and the
// ranges are clipped to them.
RangeArguments MakeRangeArguments(const BlockMap& map, const PinholeCamera& camera,
                                  const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                                  float max_depth_m);

// One range per tile of kRayTilePx pixels.
struct RayRanges {
    int width = 0, height = 0;     // tiles
    std::vector<RayRange> ranges;  // row by row

    // See MakeRangeArguments.
    void Build(const BlockMap& map, const PinholeCamera& camera,
               const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m);
};

}  // namespace tessera
