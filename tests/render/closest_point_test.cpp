#include "render/closest_point.h"

#include <gtest/gtest.h>

#include "render/random_mesh.h"

namespace tessera {
namespace {

using Eigen::Vector3d;

const Vector3d kA(0, 0, 0), kB(2, 0, 0), kC(0, 2, 0);

TEST(ClosestPoint, EachOfTheSevenRegions) {
    const struct {
        Vector3d p, expected;
    } cases[] = {
        {{0.5, 0.5, 3}, {0.5, 0.5, 0}},                            // inside
        {{0.5, 0.5, -1}, {0.5, 0.5, 0}}, {{1, -1, 1}, {1, 0, 0}},  // edges
        {{-1, 1, 1}, {0, 1, 0}},         {{2, 2, 0}, {1, 1, 0}},
        {{-1, -1, 2}, {0, 0, 0}},        {{4, -1, 0}, {2, 0, 0}},  // corners
        {{-1, 5, 0}, {0, 2, 0}},
    };
    for (const auto& [p, expected] : cases)
        EXPECT_LT((ClosestOnTriangle(p, kA, kB, kC) - expected).norm(), 1e-15) << p.transpose();
}

TEST(ClosestPoint, TrianglesWithoutArea) {
    const Vector3d p(0.5, 1, 0), q(3, 4, 0);
    EXPECT_LT((ClosestOnTriangle(p, kA, kB, 0.5 * kB) - Vector3d(0.5, 0, 0)).norm(), 1e-15);
    EXPECT_LT((ClosestOnTriangle(q, kA, 0.5 * kB, kB) - kB).norm(), 1e-15);
    EXPECT_EQ(ClosestOnTriangle(q, kC, kC, kC), kC);
    EXPECT_LT((ClosestOnTriangle(q, kA, kA, kB) - kB).norm(), 1e-15);
}

// Checks that no point of a fine grid on the triangle is nearer.
TEST(ClosestPoint, NoGridPointIsNearer) {
    TestRandom random(7);
    for (int n = 0; n < 200; ++n) {
        const Vector3d a = random.Point(1), b = random.Point(1), c = random.Point(1);
        const Vector3d p = random.Point(2);
        const double distance = (ClosestOnTriangle(p, a, b, c) - p).norm();
        double nearest = 1e9;
        constexpr int kSteps = 60;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; i + j <= kSteps; ++j) {
                const double u = double(i) / kSteps, v = double(j) / kSteps;
                nearest = std::min(nearest, (a + u * (b - a) + v * (c - a) - p).norm());
            }
        EXPECT_LE(distance, nearest + 1e-12);
        EXPECT_GT(distance, nearest - 0.06);  // half the diagonal of a grid cell
    }
}

}  // namespace
}  // namespace tessera
