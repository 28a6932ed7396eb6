#include "tracking/levenberg_marquardt.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(LevenbergMarquardt, NeverTakesAStepThatDoesNotLowerTheEnergy) {
    for (const double fall : {0.0, -1e-12, -5.0, std::nan("")}) {
        LevenbergMarquardt lm;
        const double before = lm.damping();
        EXPECT_FALSE(lm.Accept(fall, 1.0)) << fall;
        EXPECT_GT(lm.damping(), before);
    }
}

TEST(LevenbergMarquardt, DampingFollowsTheGainRatio) {
    LevenbergMarquardt good, half, bad;
    const double before = good.damping();
    EXPECT_TRUE(good.Accept(1.0, 1.0));
    EXPECT_DOUBLE_EQ(good.damping(), before / 3);
    EXPECT_TRUE(half.Accept(0.5, 1.0));
    EXPECT_DOUBLE_EQ(half.damping(), before);
    EXPECT_TRUE(bad.Accept(0.01, 1.0));
    EXPECT_GT(bad.damping(), 1.9 * before);
}

TEST(LevenbergMarquardt, FailuresInARowGrowFasterAndFaster) {
    LevenbergMarquardt lm;
    lm.Accept(-1, 1);
    const double one = lm.damping();
    lm.Accept(-1, 1);
    const double two = lm.damping();
    lm.Accept(-1, 1);
    EXPECT_DOUBLE_EQ(two / one, 4);
    EXPECT_DOUBLE_EQ(lm.damping() / two, 8);
}

// Rosenbrock's valley, where the first full Gauss-Newton step increases the energy. The energy must
// never rise, and the minimum must be found.
TEST(LevenbergMarquardt, DescendsACurvedValley) {
    double x = -1.2, y = 1.0, energy = 1e9;
    LevenbergMarquardt lm;
    for (int i = 0; i < 200; ++i) {
        const auto residuals = [](double a, double b) {
            return std::pair{10 * (b - a * a), 1 - a};
        };
        const auto [r0, r1] = residuals(x, y);
        const double before = r0 * r0 + r1 * r1;
        EXPECT_LE(before, energy);
        energy = before;
        const double j00 = -20 * x, h00 = j00 * j00 + 1, h01 = j00 * 10, h11 = 100;
        const double g0 = j00 * r0 - r1, g1 = 10 * r0, d = lm.damping() * (h00 + h11);
        const double det = (h00 + d) * (h11 + d) - h01 * h01;
        const double sx = -((h11 + d) * g0 - h01 * g1) / det,
                     sy = -((h00 + d) * g1 - h01 * g0) / det;
        const auto [t0, t1] = residuals(x + sx, y + sy);
        const double predicted =
            -(2 * (g0 * sx + g1 * sy) + h00 * sx * sx + 2 * h01 * sx * sy + h11 * sy * sy);
        if (!lm.Accept(before - t0 * t0 - t1 * t1, predicted)) continue;
        x += sx;
        y += sy;
    }
    EXPECT_NEAR(x, 1, 1e-6);
    EXPECT_NEAR(y, 1, 1e-6);
}

}  // namespace
}  // namespace tessera
