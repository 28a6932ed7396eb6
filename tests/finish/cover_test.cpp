#include "finish/cover.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace tessera {
namespace {

using Corners = std::array<Eigen::Vector2f, 3>;

// The plain definition: distance from the triangle's edge lines, point by point.
std::set<std::pair<int, int>> Slowly(const Corners& c, double margin) {
    std::set<std::pair<int, int>> covered;
    const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
        return u.x() * v.y() - u.y() * v.x();
    };
    const Eigen::Vector2d p[3] = {c[0].cast<double>(), c[1].cast<double>(), c[2].cast<double>()};
    const double turn = cross(p[1] - p[0], p[2] - p[0]) > 0 ? 1 : -1;
    for (int y = -20; y <= 40; ++y)
        for (int x = -20; x <= 40; ++x) {
            double least = 1e9, low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
            for (int k = 0; k < 3; ++k) {
                const Eigen::Vector2d a = p[k], side = p[(k + 1) % 3] - a;
                least =
                    std::min(least, turn * cross(side, Eigen::Vector2d(x, y) - a) / side.norm());
                low_x = std::min(low_x, a.x()), high_x = std::max(high_x, a.x());
                low_y = std::min(low_y, a.y()), high_y = std::max(high_y, a.y());
            }
            // A sharp corner's lines run far: only near the triangle's box.
            if (least >= -margin && x >= low_x - margin && x <= high_x + margin &&
                y >= low_y - margin && y <= high_y + margin)
                covered.insert({x, y});
        }
    return covered;
}

TEST(Cover, IsThePointsInsideOrNearEitherWayRound) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(0, 20);
    for (int i = 0; i < 300; ++i) {
        Corners corners;
        for (Eigen::Vector2f& c : corners) c = {place(random), place(random)};
        const Eigen::Vector2f ab = corners[1] - corners[0], ac = corners[2] - corners[0];
        if (std::abs(ab.x() * ac.y() - ab.y() * ac.x()) < 1) continue;  // may be too thin
        for (const float margin : {-0.05f, 1e-3f, 1.5f}) {
            std::set<std::pair<int, int>> covered;
            ForEachCovered(corners, margin, [&](int x, int y, const Eigen::Vector3f& weights) {
                EXPECT_TRUE(covered.insert({x, y}).second);
                EXPECT_NEAR(weights.sum(), 1, 1e-5f);
                EXPECT_GE(weights.minCoeff(), 0);
                const Eigen::Vector2f there =
                    weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
                if (margin < 0.01f) {
                    EXPECT_LT(
                        (there - Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)))
                            .norm(),
                        0.01f);
                }
            });
            EXPECT_EQ(covered, Slowly(corners, margin)) << i << " " << margin;
        }
    }
}

TEST(Cover, OutsideTheWeightsAreThoseOfTheNearestPoint) {
    const Corners corners{Eigen::Vector2f(0, 0), {10, 0}, {10.5f, 0.5f}};  // obtuse and thin
    int outside = 0;
    ForEachCovered(corners, 1.5f, [&](int x, int y, const Eigen::Vector3f& w) {
        const Eigen::Vector2f p(static_cast<float>(x), static_cast<float>(y));
        const Eigen::Vector2f there = w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2];
        float nearest = 100;
        for (int i = 0; i <= 1000; ++i)
            for (int k = 0; k < 3; ++k)
                nearest = std::min(nearest, (corners[static_cast<std::size_t>(k)] +
                                             0.001f * static_cast<float>(i) *
                                                 (corners[static_cast<std::size_t>((k + 1) % 3)] -
                                                  corners[static_cast<std::size_t>(k)]) -
                                             p)
                                                .norm());
        if (y >= 0) return;
        ++outside;
        EXPECT_NEAR((there - p).norm(), nearest, 0.02f) << x << " " << y;
    });
    EXPECT_GE(outside, 9);
}

TEST(Cover, NeighboursLeaveNoGap) {
    int covered[12][12] = {};
    const Eigen::Vector2f a(0.3f, 0.2f), b(10.7f, 0.4f), c(10.5f, 10.8f), d(0.1f, 10.6f);
    for (const Corners& corners : {Corners{a, b, c}, Corners{a, c, d}})
        ForEachCovered(corners, 1e-3f, [&](int x, int y, const auto&) { ++covered[y][x]; });
    for (int y = 1; y <= 10; ++y)
        for (int x = 1; x <= 10; ++x) EXPECT_GE(covered[y][x], 1) << x << " " << y;
}

TEST(Cover, WhatHasNoAreaCoversNothing) {
    int points = 0;
    ForEachCovered(Corners{Eigen::Vector2f(0, 0), {5, 5}, {10, 10}}, 1.0f,
                   [&](int, int, const auto&) { ++points; });
    EXPECT_EQ(points, 0);
}

}  // namespace
}  // namespace tessera
