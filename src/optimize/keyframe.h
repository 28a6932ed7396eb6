// One remembered view: what is needed to recognise it, to link it with others and to move what was
// fused by it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/camera.h"
#include "core/image.h"
#include "optimize/features.h"

namespace tessera {

inline constexpr int kKeyframeReduction = 16;  // of Keyframe::depth_m, against the image

struct Keyframe {
    int id = 0;  // position in the list of all
    std::int64_t frame_index = 0;
    double stamp_s = 0;
    // Where the present map has it.
    Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();
    // By the pose graph: where it belongs.
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    Features features;
    DepthImage depth_m;  // much reduced, of `view`
    PinholeCamera view;
    double way_m = 0, turned_rad = 0;  // that the camera went and turned before it came here
    double inlier_fraction = 0;        // of the tracked frame, TrackResult
};

}  // namespace tessera
