// Rigid motions. The one place that states the conventions: a twist is (rotation, translation), as
// [B14] eq. 9, radians and metres, and increments multiply from the left:  T_new =
// Se3Exp(increment) * T_old.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tessera {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// exp: se(3) -> SE(3), exact for every angle.
Eigen::Isometry3d Se3Exp(const Vector6d& twist);

// log: SE(3) -> se(3), rotation angle in [0, pi].
Vector6d Se3Log(const Eigen::Isometry3d& T);

// With its nearly orthonormal rotation made exactly so: products of many poses lose it, and an
// isometry's inverse doubles the error.
Eigen::Isometry3d Normalised(const Eigen::Isometry3d& T);

// Skew(a) * b == a x b.
Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

// The angle of the rotation between two poses, radians in [0, pi].
double RotationAngle(const Eigen::Isometry3d& A, const Eigen::Isometry3d& B);

// A pose at a time.
struct StampedPose {
    double stamp_s = 0;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

}  // namespace tessera
