// Tests of how well a frame determines its pose. The values follow from exact geometry and known
// noise.
#include "tracking/pose_information.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

namespace tessera {
namespace {

// Patches of unit weight on planes with these normals, seen by the camera from 1 m. Each normal has
// its own noise.
std::vector<double> Patches(int blocks, const std::vector<Eigen::Vector3d>& normals, double noise) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::vector<double> sums;
    for (int block = 0; block < blocks; ++block)
        for (int patch = 0; patch < 4; ++patch) {
            const Eigen::Vector3d p(0.1 * (block % 10 - 4.5), 0.1 * (block / 10 % 10 - 4.5), 1);
            Eigen::Vector3d n = normals[static_cast<std::size_t>(block) % normals.size()];
            for (int k = 0; k < 3; ++k) n(k) += noise * normal(random);
            Vector6d j;
            j << p.cross(n), n;
            sums.push_back(1);
            sums.insert(sums.end(), j.begin(), j.end());
            sums.insert(sums.end(), 6, 0.0);
        }
    return sums;
}

Vector6d Eigenvalues(const Matrix6d& m) {
    return Eigen::SelfAdjointEigenSolver<Matrix6d>(m).eigenvalues();
}

// A wall determines three motions. Noise in its normals makes the other three look determined if
// patches are squared (0.01 x 400), but not if different patches are multiplied.
TEST(AgreedHessian, NoiseOfNormalsIsNoInformation) {
    const std::vector<double> wall = Patches(100, {{0, 0, -1}}, 0.1);
    Matrix6d squared = Matrix6d::Zero();
    for (std::size_t at = 0; at < wall.size(); at += DistanceSums::kSums) {
        const Vector6d j = Eigen::Map<const Vector6d>(wall.data() + at + DistanceSums::kJacobian);
        squared += j * j.transpose();
    }
    EXPECT_GT(Eigenvalues(squared)(1), 3);
    const Vector6d agreed = Eigenvalues(AgreedHessian(wall));
    for (int i = 0; i < 3; ++i) EXPECT_LT(agreed(i), 0.5) << i;
    EXPECT_GT(agreed(3), 20);
}

TEST(AgreedHessian, IsTheHessianWhereThereIsNoNoise) {
    const std::vector<double> corner = Patches(99, {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}, 0);
    Matrix6d hessian = Matrix6d::Zero();
    for (std::size_t at = 0; at < corner.size(); at += DistanceSums::kSums) {
        const Vector6d j = Eigen::Map<const Vector6d>(corner.data() + at + DistanceSums::kJacobian);
        hessian += j * j.transpose();
    }
    EXPECT_TRUE(AgreedHessian(corner).isApprox(hessian, 1e-12));
}

// 400 points of weight 1 with errors of 1 cm determine the distance of a wall to 1 cm / 20.
TEST(PoseInformation, IsInMetresAndGrowsWithEveryResidual) {
    ResidualSums residuals;
    residuals.distances = Patches(100, {{0, 0, -1}}, 0);
    ResidualScales scales;
    scales.distance_m2 = 1e-4;
    PoseTerm intensities{Matrix6d::Zero(), Vector6d::Zero()};
    const Matrix6d geometry = PoseInformation(residuals, intensities, scales, 2.0);
    EXPECT_NEAR(1 / std::sqrt(geometry(5, 5)), 0.01 / 20, 1e-9);
    EXPECT_NEAR(geometry(3, 3), 0, 1e-6);

    scales.intensity = 1e-4;
    intensities.H(3, 3) = 4;
    const Matrix6d both = PoseInformation(residuals, intensities, scales, 2.0);
    EXPECT_NEAR(1 / std::sqrt(both(3, 3)), 0.005, 1e-9);
    EXPECT_GE(Eigenvalues(both - geometry)(0), -1e-6);
    scales.texture = 0.25;  // three quarters of it are noise
    EXPECT_NEAR(1 / std::sqrt(PoseInformation(residuals, intensities, scales, 2.0)(3, 3)), 0.01,
                1e-9);
}

// x is known to 1 mm, y to 1 cm, which equals the prior's standard deviation, and the other motions
// are unknown.
TEST(PoseUncertainty, MotionsFollowWhatWasExpectedAsFarAsTheFrameDoesNotKnowThem) {
    Matrix6d information = Matrix6d::Zero();
    information(3, 3) = 1e6;
    information(4, 4) = 1e4;
    const PoseUncertainty knowledge =
        ComputeUncertainty(information, 0.01, Eigen::Vector3d::Zero(), 1.0);
    EXPECT_GT(knowledge.uncertainty_m, 100);
    Vector6d expected;
    expected << 1, 1, 1, 1 / 10001.0, 0.5, 1;
    EXPECT_TRUE(Matrix6d(knowledge.open).isApprox(Matrix6d(expected.asDiagonal()), 1e-9));
    EXPECT_TRUE(
        ComputeUncertainty(information, 0, Eigen::Vector3d::Zero(), 1.0).open.isZero(1e-12));
    information.diagonal().setConstant(1e4);
    EXPECT_NEAR(ComputeUncertainty(information, 0.01, Eigen::Vector3d(1, 2, 3), 2.0).uncertainty_m,
                0.01, 1e-9);
}

// The same as weighing the points of the finest level against the prior.
TEST(PoseUncertainty, LeastDampingIsThatOfTheExpectation) {
    ResidualScales scales;
    scales.distance_m2 = 4e-4;
    EXPECT_DOUBLE_EQ(LeastDamping(scales, 0.01, 0), 4);
    EXPECT_DOUBLE_EQ(LeastDamping(scales, 0.01, 2), 0.25);
    EXPECT_DOUBLE_EQ(LeastDamping(scales, 0, 0), 0);
}

}  // namespace
}  // namespace tessera
