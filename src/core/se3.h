// Rigid motions. This file defines the conventions: a twist is (rotation, translation) as in [B14]
// eq. 9, in radians and metres. Increments multiply from the left:
//     T_new = Se3Exp(increment) * T_old
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

// Returns T with its rotation made exactly orthonormal. Products of many poses drift from
// orthonormal, and inverting an isometry doubles the error.
Eigen::Isometry3d Normalised(const Eigen::Isometry3d& T);

// Skew(a) * b == a x b.
Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

// The same motion on the other side: Se3Exp(Adjoint(T) * twist) * T == T * Se3Exp(twist).
Matrix6d Adjoint(const Eigen::Isometry3d& T);

// The angle of the rotation between two poses, radians in [0, pi].
double RotationAngle(const Eigen::Isometry3d& A, const Eigen::Isometry3d& B);

// A pose at a time.
struct StampedPose {
    double stamp_s = 0;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

}  // namespace tessera
