// Tests of the step computed from the sums, and of the damping of undetermined motions.
#include "tracking/pose_solver.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

using L = SumLayout;

void SetTerm(const Vector6d& h, const Vector6d& g, int term, PoseSums& sums) {
    for (int i = 0, at = term + L::kHessian; i < 6; ++i) {
        for (int j = i; j < 6; ++j, ++at) sums.value[at] = i == j ? h(i) : 0.0;
        sums.value[term + L::kGradient + i] = g(i);
    }
}

Vector6d V(double a, double b, double c, double d, double e, double f) {
    return (Vector6d() << a, b, c, d, e, f).finished();
}

PoseStep Solve(const PoseSums& sums, double alpha, double least_damping) {
    SolverOptions options;
    options.alpha = alpha;
    options.least_damping = least_damping;
    options.estimate_brightness = false;
    return SolvePoseStep(sums, options, 1, 0, Eigen::Vector3d::Zero(), 1.0);
}

// Distances ask for 1 cm along x, intensities for 3 cm. alpha weighs the two.
TEST(PoseSolver, WeighsTheTwoKindsByAlpha) {
    const Vector6d ones = Vector6d::Ones(), h_c = 2 * ones;
    PoseSums sums;
    SetTerm(ones, -0.01 * V(0, 0, 0, 1, 0, 0), L::kDistance, sums);
    SetTerm(h_c, -0.03 * 2 * V(0, 0, 0, 1, 0, 0), L::kIntensity, sums);
    for (const double alpha : {0.0, 0.5, 10.0}) {
        const PoseStep step = Solve(sums, alpha, 0);
        ASSERT_TRUE(step.valid);
        EXPECT_NEAR(step.increment(3), (0.01 + 2 * alpha * 0.03) / (1 + 2 * alpha), 1e-9) << alpha;
    }
}

TEST(PoseSolver, WhatNothingShowsDoesNotRunAway) {
    PoseSums sums;
    SetTerm(V(1, 1, 1, 1, 1, 1e-8), -0.01 * V(0, 0, 0, 1, 1, 1e-5), L::kDistance, sums);
    EXPECT_GT(Solve(sums, 0, 0).increment(5), 1);
    const PoseStep step = Solve(sums, 0, 1e-3);
    EXPECT_LT(std::abs(step.increment(5)), 1e-3);
    EXPECT_NEAR(step.increment(3), 0.01, 2e-5);
    EXPECT_FALSE(Solve(PoseSums(), 0, 1e-3).valid);
}

// If gain and offset alone explain the pose gradient, the pose does not move.
TEST(PoseSolver, BrightnessIsEliminated) {
    PoseSums sums;
    SetTerm(Vector6d::Ones(), Vector6d::Zero(), L::kDistance, sums);
    SetTerm(Vector6d::Ones(), V(0, 0, 0, 0.05, 0, 0), L::kIntensity, sums);
    sums.value[L::kCoupling + 2 * 3 + 1] = 0.5;  // couples x with the offset
    sums.value[L::kBrightness] = sums.value[L::kBrightness + 2] = 1;
    sums.value[L::kBrightnessGradient + 1] = 0.1;  // 0.05 = 0.5 * 0.1
    SolverOptions options;
    options.alpha = 1;
    const PoseStep step = SolvePoseStep(sums, options, 1, 0, Eigen::Vector3d::Zero(), 1.0);
    EXPECT_LT(step.increment.norm(), 1e-12);
    EXPECT_NEAR(step.offset_change, -0.1, 1e-12);
    const PoseTerm term = IntensityTerm(sums, options, 1, 0);
    EXPECT_NEAR(term.H(3, 3), 1 - 0.25, 1e-12);
    EXPECT_NEAR(term.g(3), 0, 1e-12);
}

}  // namespace
}  // namespace tessera
