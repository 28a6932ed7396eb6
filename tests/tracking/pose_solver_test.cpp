// Which motions a step leaves alone, and what becomes of the pose along them.
#include "tracking/pose_solver.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

using L = SumLayout;

// Of a camera at the local origin, 1 m from what it sees, so that the normalised Hessian is diag(h) over its trace.
PoseSums Sums(const Vector6d& h, const Vector6d& g) {
    PoseSums sums;
    for (int i = 0, at = 0; i < 6; ++i) {
        for (int j = i; j < 6; ++j, ++at) sums.value[L::kHessian + at] = i == j ? h(i) : 0.0;
        sums.value[L::kGradient + i] = g(i);
    }
    return sums;
}

PoseStep Solve(const Vector6d& h, bool last_degenerate) {
    SolverOptions options;
    options.estimate_brightness = false;
    options.min_eigenvalue = 1e-3;
    options.last_degenerate = last_degenerate;
    return SolvePoseStep(Sums(h, -0.01 * h), options, 1, 0, Eigen::Vector3d::Zero(), 1.0);
}

Vector6d V(double a, double b, double c, double d, double e, double f) { return (Vector6d() << a, b, c, d, e, f).finished(); }

TEST(PoseSolver, HoldsWhatTheSceneLeavesOpen) {
    // Shares of the trace: one of 1.2e-3 is enough, unless another is below 1e-3 or the last frame's was.
    EXPECT_EQ(Solve(V(1, 1, 1, 1, 0.006, 1), false).held_directions, 0);
    EXPECT_EQ(Solve(V(1, 1, 1, 1, 0.006, 1), true).held_directions, 1);
    EXPECT_EQ(Solve(V(1, 1, 1, 1, 0.012, 1), true).held_directions, 0);
    EXPECT_EQ(Solve(V(1, 1, 1, 0.006, 0.012, 1), true).held_directions, 2);
    const PoseStep step = Solve(V(1, 1, 1, 0.001, 0.01, 1), false);
    EXPECT_EQ(step.held_directions, 2);
    EXPECT_LT((step.increment - V(0.01, 0.01, 0.01, 0, 0, 0.01)).norm(), 1e-12);
    EXPECT_FALSE(Solve(Vector6d::Zero(), false).valid);
}

TEST(PoseSolver, AlongHeldDirectionsThePoseIsAsExpected) {
    const Eigen::Isometry3d found = Se3Exp(V(0.3, -0.2, 0.1, 1, 2, 3));
    const Vector6d away = V(0.004, -0.003, 0.002, 0.01, 0.02, -0.03);
    const Eigen::Isometry3d expected = Se3Exp(-away) * found;
    EXPECT_TRUE(WithHeldAsExpected(Solve(V(1, 1, 1, 1, 1, 1), false), found, expected).isApprox(found, 1e-15));
    const Eigen::Isometry3d T = WithHeldAsExpected(Solve(V(1, 1, 1, 1e-6, 1e-6, 1), false), found, expected);
    EXPECT_LT((Se3Log(T * expected.inverse()) - V(0.004, -0.003, 0.002, 0, 0, -0.03)).norm(), 1e-4);
}

}  // namespace
}  // namespace tessera
