#include "tracking/icp_kernels.h"

#include <gtest/gtest.h>

#include "core/se3.h"

namespace tessera {
namespace {

// Checks d(residual)/d(increment) of both terms against central differences, with a fixed
// correspondence.
TEST(IcpKernels, JacobiansMatchCentralDifferences) {
    const Eigen::Vector3d p(0.21, -0.13, 1.4), n = Eigen::Vector3d(0.2, -0.3, -1).normalized(),
                                               partner(0.2, -0.1, 1.43);
    const double pixel[4] = {0.3, 0.5, 0.45, 0.2}, fx = 200, fy = 210;
    const auto sample = [&](const Eigen::Vector3d& q) {  // around the pixel onto which p projects
        const double u = fx * q.x() / q.z() - fx * p.x() / p.z() + 0.4,
                     v = fy * q.y() / q.z() - fy * p.y() / p.z() + 0.6;
        return Bilinear<double>(pixel[0], pixel[1], pixel[2], pixel[3], u, v);
    };
    const double point[3] = {p.x(), p.y(), p.z()}, plane[3] = {n.x(), n.y(), n.z()};
    double g[3], j_distance[6], j_intensity[6];
    PointJacobian(point, plane, j_distance);
    ImageGradientInSpace<double>(point, fx, fy, sample(p).du, sample(p).dv, g);
    PointJacobian(point, g, j_intensity);
    for (int k = 0; k < 6; ++k) {
        constexpr double kStep = 1e-6;
        Vector6d twist = Vector6d::Zero();
        twist(k) = kStep;
        const Eigen::Vector3d forward = Se3Exp(twist) * p, back = Se3Exp(-twist) * p;
        EXPECT_NEAR(j_distance[k], (n.dot(forward - partner) - n.dot(back - partner)) / (2 * kStep),
                    1e-8)
            << k;
        EXPECT_NEAR(j_intensity[k], (sample(forward).value - sample(back).value) / (2 * kStep),
                    1e-6)
            << k;
    }
}

TEST(IcpKernels, HuberCostJoinsItsPartsSmoothly) {
    EXPECT_FLOAT_EQ(HuberCost(0.01f, 0.02f), 1e-4f);
    EXPECT_FLOAT_EQ(HuberCost(-0.05f, 0.02f), 0.02f * (0.1f - 0.02f));
    EXPECT_NEAR(HuberCost(0.02001f, 0.02f), HuberCost(0.01999f, 0.02f), 1e-6f);
}

}  // namespace
}  // namespace tessera
