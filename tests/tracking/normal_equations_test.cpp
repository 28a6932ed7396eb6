#include "tracking/normal_equations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/se3.h"

namespace tessera {
namespace {

// A trilinear cell stands for any field. Compares the residual and its Jacobian with central
// differences of the whole chain: increment -> moved point -> interpolation.
struct Cell {
    double corner[8] = {0.3, -0.2, 0.5, 0.1, -0.4, 0.7, 0.2, -0.1};

    ValueAndGradient<double> At(const Eigen::Vector3d& p) const {
        return Trilinear<double>(corner, p.x(), p.y(), p.z());
    }
};

TEST(Trilinear, ReproducesCornersAndLinearFields) {
    const Cell cell;
    for (int c = 0; c < 8; ++c)
        EXPECT_DOUBLE_EQ(cell.At({double(c & 1), double(c >> 1 & 1), double(c >> 2)}).value,
                         cell.corner[c]);
    double linear[8];
    for (int c = 0; c < 8; ++c) linear[c] = 1 + 2 * (c & 1) - 3 * (c >> 1 & 1) + 5 * (c >> 2);
    const auto s = Trilinear<double>(linear, 0.3, 0.8, 0.6);
    EXPECT_NEAR(s.value, 1 + 0.6 - 2.4 + 3.0, 1e-12);
    EXPECT_NEAR(s.gx, 2, 1e-12);
    EXPECT_NEAR(s.gy, -3, 1e-12);
    EXPECT_NEAR(s.gz, 5, 1e-12);
}

TEST(PointJacobian, MatchesCentralDifferencesOfALeftIncrement) {
    const Cell cell;
    const Eigen::Vector3d p(0.4, 0.55, 0.35);
    const auto s = cell.At(p);
    const double point[3] = {p.x(), p.y(), p.z()}, gradient[3] = {s.gx, s.gy, s.gz};
    double j[6];
    PointJacobian(point, gradient, j);
    for (int k = 0; k < 6; ++k) {
        constexpr double kStep = 1e-6;
        Vector6d twist = Vector6d::Zero();
        twist(k) = kStep;
        const double forward = cell.At(Se3Exp(twist) * p).value,
                     back = cell.At(Se3Exp(-twist) * p).value;
        EXPECT_NEAR(j[k], (forward - back) / (2 * kStep), 1e-8) << k;
    }
}

TEST(HuberWeight, IsOneInsideAndFallsOutside) {
    EXPECT_FLOAT_EQ(HuberWeight(0.01f, 0.02f), 1.0f);
    EXPECT_FLOAT_EQ(HuberWeight(-0.04f, 0.02f), 0.5f);
    EXPECT_FLOAT_EQ(HuberWeight(0.2f, 0.02f), 0.1f);
}

// E(x) = w (r + J x)^2 / 2 for the brightness unknowns. The sums must be its gradient and Hessian.
TEST(AddBrightnessTerm, MatchesThePhotometricResidual) {
    using L = SumLayout;
    const double j[6] = {0.1, -0.2, 0.3, 0.4, 0.5, -0.6};
    const double field = 0.7, image = 0.4, gain = 1.1, offset = 0.05, w = 2.0;
    const auto residual = [&](double a, double b) { return field - (a * image + b); };
    double sums[L::kCount] = {};
    AddBrightnessTerm(j, residual(gain, offset), image, w, sums);
    constexpr double kStep = 1e-6;
    const double dr_gain =
        (residual(gain + kStep, offset) - residual(gain - kStep, offset)) / (2 * kStep);
    const double dr_offset =
        (residual(gain, offset + kStep) - residual(gain, offset - kStep)) / (2 * kStep);
    const double r = residual(gain, offset);
    EXPECT_NEAR(sums[L::kBrightness], w * dr_gain * dr_gain, 1e-8);
    EXPECT_NEAR(sums[L::kBrightness + 1], w * dr_gain * dr_offset, 1e-8);
    EXPECT_NEAR(sums[L::kBrightness + 2], w * dr_offset * dr_offset, 1e-8);
    EXPECT_NEAR(sums[L::kBrightnessGradient], w * r * dr_gain, 1e-8);
    EXPECT_NEAR(sums[L::kBrightnessGradient + 1], w * r * dr_offset, 1e-8);
    for (int k = 0; k < 6; ++k) {
        EXPECT_NEAR(sums[L::kCoupling + 2 * k], w * j[k] * dr_gain, 1e-8);
        EXPECT_NEAR(sums[L::kCoupling + 2 * k + 1], w * j[k] * dr_offset, 1e-8);
    }
}

TEST(AddPoseTerm, SumsTheUpperTriangleRowByRow) {
    using L = SumLayout;
    const double j[6] = {1, 2, 3, 4, 5, 6};
    double sums[L::kCount] = {};
    AddPoseTerm(j, 0.5, 2.0, sums);
    int at = 0;
    for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column)
            EXPECT_DOUBLE_EQ(sums[at++], 2.0 * j[row] * j[column]);
    for (int row = 0; row < 6; ++row)
        EXPECT_DOUBLE_EQ(sums[L::kGradient + row], 2.0 * j[row] * 0.5);
}

}  // namespace
}  // namespace tessera
