// Direct alignment of two keyframes: points of each on the surfaces of the other (point to plane),
// and their intensities, in one system of normal equations.
#pragma once

#include <Eigen/Geometry>

#include "core/se3.h"
#include "optimize/dense_view.h"

namespace tessera {

struct ViewAlignment {
    bool converged = false;
    Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
    // Inverse covariance of a right increment of T_a_b (rotation, translation), in 1/rad^2 and
    // 1/m^2. Follows from the scatter of the residuals.
    Matrix6d information = Matrix6d::Zero();
    double overlap = 0;  // share of the points that the other view sees; the smaller of the two
    double fit = 0;      // share of these whose residual is within three standard deviations
};

// Starts from T_a_b. Thread-safe.
ViewAlignment AlignViews(const DenseView& a, const DenseView& b, const Eigen::Isometry3d& T_a_b);

}  // namespace tessera
