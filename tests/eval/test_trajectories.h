// Synthetic trajectories for the tests of src/eval.
#pragma once

#include <cmath>
#include <vector>

#include "core/se3.h"

namespace tessera {

inline StampedPose PoseAt(double stamp_s, const Eigen::Vector3d& position) {
    StampedPose pose;
    pose.stamp_s = stamp_s;
    pose.T_world_camera.translation() = position;
    return pose;
}

inline std::vector<StampedPose> PosesAt(const std::vector<double>& stamps_s) {
    std::vector<StampedPose> poses;
    for (const double stamp_s : stamps_s) poses.push_back(PoseAt(stamp_s, {0, 0, 0}));
    return poses;
}

// A winding path at 30 Hz with a rotating camera.
inline std::vector<StampedPose> WindingPath(int count) {
    std::vector<StampedPose> poses;
    for (int i = 0; i < count; ++i) {
        const double t = i / 30.0;
        StampedPose pose = PoseAt(100 + t, {std::sin(t), 0.5 * std::cos(1.3 * t), 0.2 * t});
        Vector6d twist;
        twist << 0.3 * std::sin(t), 0.2 * t, 0.1 * std::cos(2 * t), 0, 0, 0;
        pose.T_world_camera.linear() = Se3Exp(twist).linear();
        poses.push_back(pose);
    }
    return poses;
}

inline Eigen::Isometry3d SomeTransform() {
    Vector6d twist;
    twist << 0.4, -1.1, 2.0, 3.0, -7.0, 0.5;
    return Se3Exp(twist);
}

// The same path in another world frame: T * T_world_camera.
inline std::vector<StampedPose> Moved(std::vector<StampedPose> poses, const Eigen::Isometry3d& T) {
    for (StampedPose& pose : poses) pose.T_world_camera = T * pose.T_world_camera;
    return poses;
}

}  // namespace tessera
