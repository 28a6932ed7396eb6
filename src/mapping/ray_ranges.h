// Between which depths the rays of a view can meet blocks at all: what lies before and after need
// not be walked.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "mapping/block_map.h"

namespace tessera {

// Depths along z per tile of pixels; first > last where no block is in the way.
struct RayRanges {
    static constexpr int kTilePx = 8;
    struct Range {
        float first_m, last_m;
    };
    int width = 0, height = 0;  // tiles
    std::vector<Range> ranges;  // row by row

    // Only blocks between the two depths count, and the ranges are cut to them.
    void Build(const BlockMap& map, const PinholeCamera& camera,
               const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m);
};

}  // namespace tessera
