// Joins the loop closure of two scans that see the same place: finds where the second lies in the
// first, and makes one pose graph of both.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "optimize/loop_closer.h"

namespace tessera {

// A keyframe of scan b that was found in scan a.
struct CommonPlace {
    int in_a = 0, in_b = 0;            // the nearest keyframe of a, and the keyframe of b
    Eigen::Isometry3d T_in_a_in_b;     // relative pose of the two cameras
    Eigen::Isometry3d T_world_a_in_b;  // according to a's pose graph
};

// Looks for keyframes of b in a. `a` is a's loop closure, resumed; `frames` are b's stored frames.
std::vector<CommonPlace> FindCommonPlaces(LoopCloser& a, std::span<const StoredFrame> frames,
                                          const FieldSettings& settings, double depth_units_per_m);

// The largest set of places that agree on where b lies in a.
struct JointPose {
    Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  // of the two worlds
    std::vector<CommonPlace> places;
};
// Empty unless two of these places share less than half of their view: one may be another room of
// the same kind.
std::optional<JointPose> AgreeOnPose(std::span<const CommonPlace> places,
                                     std::span<const Keyframe> keyframes_of_b);

// Appends b, with its world moved into a's, and links both at the places.
void AppendSession(LoopCloser::Memory b, const JointPose& pose, LoopCloser::Memory& a);

}  // namespace tessera
