// The normal equations of aligning one reduced image with another: six motions and an offset of the intensity. Eigenvalues of the
// Hessian are inverse variances for errors as large as the residuals' scales.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/se3.h"

namespace tessera {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

struct ImageSystem {
    Matrix7d H = Matrix7d::Zero();
    Vector7d g = Vector7d::Zero();

    double error = 0;   // sum of min((r / scale)^2, 4)
    double samples = 0;

    // The Gauss-Newton step. Along motions of the camera that are known less well than to `held_m`, a turn counting by how far it
    // moves what is `scene_depth_m` away, it is zero.
    Vector7d Step(double scene_depth_m, double held_m) const {
        const double c = std::max(H(6, 6), 1e-9);
        const Vector6d b = H.block<6, 1>(0, 6);
        Vector6d to_metres = Vector6d::Ones();
        to_metres.head<3>() /= std::max(scene_depth_m, 0.1);
        const Matrix6d N = to_metres.asDiagonal() * (H.topLeftCorner<6, 6>() - b * b.transpose() / c) * to_metres.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(N);
        Vector6d along = eigen.eigenvectors().transpose() * to_metres.asDiagonal() * (g.head<6>() - b * g(6) / c);
        for (int i = 0; i < 6; ++i)
            along(i) = eigen.eigenvalues()(i) * held_m * held_m < 1 ? 0.0 : -along(i) / eigen.eigenvalues()(i);
        Vector7d step;
        step.head<6>() = to_metres.asDiagonal() * eigen.eigenvectors() * along;
        step(6) = -(g(6) + b.dot(step.head<6>())) / c;
        return step;
    }

    // A robust mean; few samples mean little overlap, which is no merit.
    double Score() const {
        return samples > 100 ? error / samples + 200.0 / samples : std::numeric_limits<double>::infinity();
    }

    void Add(const Vector7d& j, double residual, double scale) {
        const double w = scale / std::max(std::abs(residual), scale) / (scale * scale);
        error += std::min(residual * residual / (scale * scale), 4.0);
        samples += 1;
        H.noalias() += w * j * j.transpose();
        g.noalias() += w * residual * j;
    }
};

}  // namespace tessera
