#include "tracking/pose_information.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace tessera {
namespace {

using Patch = Eigen::Map<const Eigen::Matrix<double, DistanceSums::kSums, 1>>;

// The products of different patches' sums over the products of their weights, times the block's
// weight.
Matrix6d AgreedInBlock(const double* block) {
    Matrix6d own = Matrix6d::Zero();
    Vector6d sum = Vector6d::Zero();
    double weight = 0, own_weights = 0;
    for (int i = 0; i < 4; ++i) {
        const Patch patch(block + i * DistanceSums::kSums);
        const Vector6d jacobian = patch.segment<6>(DistanceSums::kJacobian);
        own += jacobian * jacobian.transpose();
        sum += jacobian;
        weight += patch(0);
        own_weights += patch(0) * patch(0);
    }
    const double products = weight * weight - own_weights;
    // Fraction of weight^2: nearly all of the weight in one patch says nothing about agreement.
    constexpr double kLeastShare = 0.1;
    if (products <= kLeastShare * weight * weight) return Matrix6d::Zero();
    return (sum * sum.transpose() - own) * (weight / products);
}

Matrix6d WithoutNegative(const Matrix6d& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(symmetric);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
           eigen.eigenvectors().transpose();
}

}  // namespace

Matrix6d AgreedHessian(const std::vector<double>& distance_sums) {
    constexpr std::size_t kBlock = 4 * DistanceSums::kSums;
    Matrix6d H = Matrix6d::Zero();
    for (std::size_t at = 0; at + kBlock <= distance_sums.size(); at += kBlock)
        H += AgreedInBlock(distance_sums.data() + at);
    return H;
}

Matrix6d PoseInformation(const ResidualSums& residuals, const PoseTerm& intensities,
                         const ResidualScales& scales, double scene_depth_m) {
    Matrix6d information = Matrix6d::Zero();
    Vector6d to_metres = Vector6d::Ones();
    to_metres.head<3>() /= scene_depth_m;
    if (scales.distance_m2 > 0)
        information += to_metres.asDiagonal() *
                       WithoutNegative(AgreedHessian(residuals.distances)) *
                       to_metres.asDiagonal() / scales.distance_m2;
    if (scales.intensity > 0) information += intensities.H * (scales.texture / scales.intensity);
    return information;
}

double LeastDamping(const ResidualScales& scales, double expected_within_m, int level) {
    if (expected_within_m <= 0) return 0;
    constexpr double kUsual_m2 = 1e-3;  // before the first frame
    const double variance = scales.distance_m2 > 0 ? scales.distance_m2 : kUsual_m2;
    return std::ldexp(variance, -2 * level) / (expected_within_m * expected_within_m);
}

PoseUncertainty ComputeUncertainty(const Matrix6d& information, double expected_within_m,
                                   const Eigen::Vector3d& camera_local, double scene_depth_m) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
    const Vector6d values = eigen.eigenvalues().cwiseMax(0.0);
    constexpr double kUnknown_m = 1000;
    PoseUncertainty knowledge;
    knowledge.uncertainty_m = 1 / std::sqrt(std::max(values(0), 1 / (kUnknown_m * kUnknown_m)));
    const double expected =
        expected_within_m > 0 ? 1 / (expected_within_m * expected_within_m) : 0.0;
    // variance of the prior over that of the motion
    const Vector6d ratio = values / std::max(expected, 1e-12);
    const Vector6d open =
        expected > 0 ? Vector6d((1 / (1 + ratio.array().square())).matrix()) : Vector6d::Zero();
    const Matrix6d A = FromNormalised(camera_local, scene_depth_m);
    knowledge.open = A * eigen.eigenvectors() * open.asDiagonal() *
                     eigen.eigenvectors().transpose() * A.inverse();
    return knowledge;
}

}  // namespace tessera
