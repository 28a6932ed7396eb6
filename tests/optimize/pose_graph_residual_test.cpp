#include "optimize/pose_graph_residual.h"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "optimize/pose_node.h"

namespace tessera {
namespace {

Eigen::Isometry3d PoseOf(double a, double b, double c, double x, double y, double z) {
    return Se3Exp((Vector6d() << a, b, c, x, y, z).finished());
}

Vector6d ResidualOf(const PoseEdge& edge, const Eigen::Isometry3d& T_world_from,
                    const Eigen::Isometry3d& T_world_to) {
    const PoseNode from(T_world_from), to(T_world_to);
    Vector6d residual;
    EdgeResidual{edge}(from.q.coeffs().data(), from.t.data(), to.q.coeffs().data(), to.t.data(),
                       residual.data());
    return residual;
}

TEST(EdgeResidual, IsZeroWhereTheEdgeIsMetAndCountsDeviations) {
    const Eigen::Isometry3d from = PoseOf(0.1, 0.2, 0.3, 4, 5, 6),
                            edge = PoseOf(0, 0, 1.6, 1.05, 0.02, 0);
    EXPECT_LT(ResidualOf({0, 1, edge, RootInformation(0.02, 0.02)}, from, from * edge).norm(),
              1e-9);
    const Vector6d r = ResidualOf({0, 1, Eigen::Isometry3d::Identity(), RootInformation(0.1, 0.5)},
                                  from, from * PoseOf(0, 0, 0.001, 0, 1, 0));
    EXPECT_NEAR(r(2), 0.01, 1e-6);
    EXPECT_NEAR(r(4), 2, 1e-2);
}

TEST(EdgeResidual, JacobianAgreesWithCentralDifferences) {
    constexpr double kDifference = 1e-6;
    constexpr int kSizes[] = {4, 3, 4, 3};
    const EdgeResidual edge{{0, 1, PoseOf(0.5, -0.2, 0.8, 1, 2, 3), RootInformation(0.2, 0.1)}};
    PoseNode from(PoseOf(-0.4, 0.3, 0.2, 1, 0, 2)), to(PoseOf(0.3, 0.1, 0.9, 2, 2, 4));
    double* blocks[] = {from.q.coeffs().data(), from.t.data(), to.q.coeffs().data(), to.t.data()};
    double jacobian[4][24];
    double* jacobians[] = {jacobian[0], jacobian[1], jacobian[2], jacobian[3]};
    Vector6d residual;
    ceres::AutoDiffCostFunction<EdgeResidual, 6, 4, 3, 4, 3>(new EdgeResidual(edge))
        .Evaluate(blocks, residual.data(), jacobians);
    double largest = 0, error = 0;
    for (int block = 0; block < 4; ++block)
        for (int k = 0; k < kSizes[block]; ++k) {
            const double value = blocks[block][k];
            Vector6d after, before;
            blocks[block][k] = value + kDifference;
            edge(blocks[0], blocks[1], blocks[2], blocks[3], after.data());
            blocks[block][k] = value - kDifference;
            edge(blocks[0], blocks[1], blocks[2], blocks[3], before.data());
            blocks[block][k] = value;
            for (int row = 0; row < 6; ++row) {
                const double exact = jacobian[block][row * kSizes[block] + k];
                largest = std::max(largest, std::abs(exact));
                error = std::max(error,
                                 std::abs(exact - (after(row) - before(row)) / (2 * kDifference)));
            }
        }
    EXPECT_GT(largest, 1);
    EXPECT_LT(error, 1e-7 * largest);
}

}  // namespace
}  // namespace tessera
