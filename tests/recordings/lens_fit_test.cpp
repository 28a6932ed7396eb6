#include "recordings/lens_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace tessera {
namespace {

using LensShape = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

std::vector<LensPoint> LensFitGrid(double half_side, const LensShape& lens) {
    std::vector<LensPoint> points;
    for (int j = -10; j <= 10; ++j)
        for (int i = -10; i <= 10; ++i) {
            const Eigen::Vector2d p = half_side / 10 * Eigen::Vector2d(i, j);
            points.push_back({p, lens(p)});
        }
    return points;
}

TEST(LensFit, FindsALensOfItsOwnModel) {
    const double k1 = -0.3, k2 = 0.1, p1 = 0.002, p2 = -0.001, k3 = -0.02;
    const LensFit fit = FitLens(
        LensFitGrid(0.7,
                    [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
                        const double x = p.x(), y = p.y();
                        const double r2 = x * x + y * y;
                        const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
                        return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                                y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
                    }),
        500);
    EXPECT_NEAR(fit.lens.k1, k1, 1e-9);
    EXPECT_NEAR(fit.lens.k2, k2, 1e-9);
    EXPECT_NEAR(fit.lens.p1, p1, 1e-9);
    EXPECT_NEAR(fit.lens.p2, p2, 1e-9);
    EXPECT_NEAR(fit.lens.k3, k3, 1e-9);
    EXPECT_LT(fit.largest_px, 1e-6);
}

// Along a line, the best polynomial of odd degree 7 for atan(x) with slope 1 at 0 is known to have
// errors of the same size at its extremes. Here it is enough that no small change of one
// coefficient is better.
TEST(LensFit, NoOtherLensHasASmallerLargestError) {
    const auto points = LensFitGrid(0.8, [](const Eigen::Vector2d& p) -> Eigen::Vector2d {
        const double r = p.norm();
        return r > 0 ? p * (std::atan(r) / r) : p;
    });
    const LensFit fit = FitLens(points, 1);
    EXPECT_LT(fit.largest_px, 2e-3);
    const auto largest = [&](double k1, double k2, double k3) {
        double error = 0;
        for (const LensPoint& point : points) {
            const double r2 = point.ideal.squaredNorm();
            const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
            error = std::max(error, (radial * point.ideal - point.seen).norm());
        }
        return error;
    };
    const LensDistortion& lens = fit.lens;
    EXPECT_NEAR(largest(lens.k1, lens.k2, lens.k3), fit.largest_px, 1e-9);
    for (int which = 0; which < 27; ++which) {
        const auto step = [&](int place) { return 0.003 * (which / place % 3 - 1); };
        EXPECT_GE(largest(lens.k1 + step(1), lens.k2 + step(3), lens.k3 + step(9)),
                  0.97 * fit.largest_px)
            << which;
    }
}

TEST(LensFit, WithoutAFitTheErrorIsInfinite) {
    EXPECT_TRUE(std::isinf(FitLens({}, 500).largest_px));
    const auto points = LensFitGrid(
        0.5, [](const Eigen::Vector2d& p) -> Eigen::Vector2d { return p / (p.x() - p.x()); });
    EXPECT_TRUE(std::isinf(FitLens(points, 500).largest_px));
}

}  // namespace
}  // namespace tessera
