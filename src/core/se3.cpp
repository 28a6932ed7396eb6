#include "core/se3.h"

#include <cmath>

namespace tessera {

Eigen::Isometry3d Normalised(const Eigen::Isometry3d& T) {
    Eigen::Isometry3d normalised = T;
    normalised.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
    return normalised;
}

Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
    Eigen::Matrix3d m;
    m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return m;
}

namespace {

// The matrix V with t = V * (translation part of the twist). Coefficients near zero use a series.
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& omega) {
    const double angle2 = omega.squaredNorm();
    const double angle = std::sqrt(angle2);
    double b, c;  // (1 - cos a) / a^2 and (a - sin a) / a^3
    if (angle < 1e-4) {
        b = 0.5 - angle2 / 24.0;
        c = 1.0 / 6.0 - angle2 / 120.0;
    } else {
        b = (1.0 - std::cos(angle)) / angle2;
        c = (angle - std::sin(angle)) / (angle2 * angle);
    }
    const Eigen::Matrix3d W = Skew(omega);
    return Eigen::Matrix3d::Identity() + b * W + c * W * W;
}

}  // namespace

Eigen::Isometry3d Se3Exp(const Vector6d& twist) {
    const Eigen::Vector3d omega = twist.head<3>();
    const double angle = omega.norm();
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    if (angle < 1e-12) {
        T.linear() = Eigen::Quaterniond(1.0, omega.x() / 2, omega.y() / 2, omega.z() / 2)
                         .normalized()
                         .toRotationMatrix();
    } else {
        T.linear() = Eigen::AngleAxisd(angle, omega / angle).toRotationMatrix();
    }
    T.translation() = LeftJacobian(omega) * twist.tail<3>();
    return T;
}

Vector6d Se3Log(const Eigen::Isometry3d& T) {
    Eigen::Quaterniond q(T.linear());
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const double sine = q.vec().norm();
    const double scale = sine < 1e-12 ? 2.0 : 2.0 * std::atan2(sine, q.w()) / sine;
    const Eigen::Vector3d omega = scale * q.vec();
    Vector6d twist;
    twist << omega, LeftJacobian(omega).inverse() * T.translation();
    return twist;
}

Matrix6d Adjoint(const Eigen::Isometry3d& T) {
    Matrix6d result = Matrix6d::Zero();
    result.topLeftCorner<3, 3>() = result.bottomRightCorner<3, 3>() = T.linear();
    result.bottomLeftCorner<3, 3>() = Skew(T.translation()) * T.linear();
    return result;
}

double RotationAngle(const Eigen::Isometry3d& A, const Eigen::Isometry3d& B) {
    return Eigen::AngleAxisd(A.linear().transpose() * B.linear()).angle();
}

}  // namespace tessera
