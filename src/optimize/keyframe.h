// A keyframe: the data to recognise it, to link it with others and to move what was fused relative
// to it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/se3.h"
#include "optimize/dense_view.h"
#include "optimize/features.h"

namespace tessera {

inline constexpr int kKeyframeReduction = 16;  // of Keyframe::depth_m relative to the image

// What is known about the relative pose of two keyframes that see the same surface.
struct Overlap {
    int with = 0;  // the earlier keyframe
    // By direct alignment of the two views.
    Eigen::Isometry3d T_with_this_aligned = Eigen::Isometry3d::Identity();
    // Inverse covariance of a right increment of it: of the alignment's residuals, of a floor, and
    // of both frames' skew.
    Matrix6d information = Matrix6d::Zero();
    // As both were tracked in the same map; empty if this keyframe was tracked elsewhere.
    std::optional<Eigen::Isometry3d> T_with_this_tracked;
};

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
    ReducedView reduced;
    // Standard deviation of the camera's motion while the rows of its frame were read; 0 for a
    // global shutter. Colour is put right for it (MakeReducedView), the rows of depth are not.
    double skew_m = 0, skew_rad = 0;
    std::vector<Overlap> overlaps;  // with earlier keyframes
    double path_length_m = 0,
           turned_rad = 0;       // distance and rotation that the camera covered before it
    double inlier_fraction = 0;  // TrackResult::inlier_fraction of its frame
};

}  // namespace tessera
