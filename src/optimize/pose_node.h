// A pose in the form that Ceres optimises.
#pragma once

#include <Eigen/Geometry>

#include "core/se3.h"

namespace tessera {

struct PoseNode {
    Eigen::Quaterniond q;
    Eigen::Vector3d t;

    explicit PoseNode(const Eigen::Isometry3d& T) : q(T.linear()), t(T.translation()) {}
    Eigen::Isometry3d Pose() const { return Normalised(Eigen::Translation3d(t) * q.normalized()); }
};

}  // namespace tessera
