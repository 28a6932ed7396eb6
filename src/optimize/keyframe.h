// A keyframe: the data to recognise it, to link it with others and to move what was fused relative
// to it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/camera.h"
#include "core/image.h"
#include "optimize/features.h"

namespace tessera {

inline constexpr int kKeyframeReduction = 16;  // of Keyframe::depth_m relative to the image

struct Keyframe {
    int id = 0;  // index in the list of keyframes
    std::int64_t frame_index = 0;
    double stamp_s = 0;
    // Pose in the current map.
    Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();
    // Pose according to the pose graph.
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    Features features;
    DepthImage depth_m;  // reduced, with camera `view`
    PinholeCamera view;
    double path_length_m = 0,
           turned_rad = 0;       // distance and rotation that the camera covered before it
    double inlier_fraction = 0;  // TrackResult::inlier_fraction of its frame
};

}  // namespace tessera
