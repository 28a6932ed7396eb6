// The normal equations for aligning one reduced image with another, from the sums of AlignKernels:
// six degrees of freedom and an intensity offset. The Hessian's eigenvalues are inverse variances
// for errors as large as the residuals' scales.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "core/se3.h"
#include "tracking/pose_solver.h"

namespace tessera {

class ImageSystem {
  public:
    explicit ImageSystem(const PoseSums& sums)
        : error_(sums[L::kDistanceError]), residuals_(sums[L::kKnown]) {
        int at = L::kHessian;
        for (int row = 0; row < 6; ++row) {
            for (int column = row; column < 6; ++column, ++at)
                H_(row, column) = H_(column, row) = sums[at];
            g_(row) = sums[L::kGradient + row];
            by_offset_(row) = sums[L::kCoupling + 2 * row + 1];
        }
        offset_H_ = std::max(sums[L::kBrightness + 2], 1e-9);
        offset_g_ = sums[L::kBrightnessGradient + 1];
    }

    struct Step {
        Vector6d twist;
        double offset;
    };
    // The Gauss-Newton step. It is zero along camera motions whose standard deviation exceeds
    // `held_m`. A rotation counts by how far it moves a point at `scene_depth_m`.
    Step Solve(double scene_depth_m, double held_m) const {
        Vector6d to_metres = Vector6d::Ones();
        to_metres.head<3>() /= std::max(scene_depth_m, 0.1);
        const Matrix6d N = to_metres.asDiagonal() *
                           (H_ - by_offset_ * by_offset_.transpose() / offset_H_) *
                           to_metres.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(N);
        Vector6d along = eigen.eigenvectors().transpose() * to_metres.asDiagonal() *
                         (g_ - by_offset_ * offset_g_ / offset_H_);
        for (int i = 0; i < 6; ++i)
            along(i) = eigen.eigenvalues()(i) * held_m * held_m < 1
                           ? 0.0
                           : -along(i) / eigen.eigenvalues()(i);
        const Vector6d twist = to_metres.asDiagonal() * eigen.eigenvectors() * along;
        return {twist, -(offset_g_ + by_offset_.dot(twist)) / offset_H_};
    }

    // A robust mean. Few residuals mean little overlap and are penalised.
    double Score() const {
        return residuals_ > 100 ? error_ / residuals_ + 200.0 / residuals_
                                : std::numeric_limits<double>::infinity();
    }

  private:
    using L = SumLayout;

    Matrix6d H_;
    Vector6d g_, by_offset_;
    double offset_H_, offset_g_;
    double error_, residuals_;
};

}  // namespace tessera
