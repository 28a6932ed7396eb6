#include "finish/polygon_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "finish/fair_heights.h"

namespace tessera {
namespace {

using Eigen::Vector2d;

std::vector<Vector2d> Circle(int corners, double radius, double teeth = 0) {
    std::vector<Vector2d> polygon;
    for (int i = 0; i < corners; ++i) {
        const double a = 2 * std::numbers::pi * i / corners, r = radius * (i % 2 ? 1 - teeth : 1);
        polygon.emplace_back(r * std::cos(a), r * std::sin(a));
    }
    return polygon;
}

double AreaOfPolygon(const std::vector<Vector2d>& p) {
    double twice = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vector2d &a = p[i], &b = p[(i + 1) % p.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return twice / 2;
}

// Covers the polygon once, and neighbours know one another.
void ExpectTriangulates(const std::vector<Vector2d>& polygon, const PolygonMesh& mesh) {
    double area = 0;
    std::size_t border = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::vector<Vector2d> corners;
        for (const std::uint32_t v : mesh.triangles[t]) corners.push_back(mesh.points.at(v));
        EXPECT_GT(AreaOfPolygon(corners), 0);
        area += AreaOfPolygon(corners);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t n = mesh.neighbours[t][k], a = mesh.triangles[t][k],
                                b = mesh.triangles[t][(k + 1) % 3];
            if (n == PolygonMesh::kNone) {
                ++border;
                EXPECT_EQ(b, (a + 1) % polygon.size());
                continue;
            }
            bool found = false;
            for (std::size_t m = 0; m < 3; ++m)
                found |= mesh.neighbours[n][m] == t && mesh.triangles[n][m] == b &&
                         mesh.triangles[n][(m + 1) % 3] == a;
            EXPECT_TRUE(found);
        }
    }
    EXPECT_EQ(border, polygon.size());
    EXPECT_NEAR(area, AreaOfPolygon(polygon), 1e-9 * area);
    EXPECT_EQ(mesh.triangles.size(), 2 * mesh.points.size() - polygon.size() - 2);
}

TEST(PolygonMesh, CirclesStarsAndCombsAreCoveredOnce) {
    std::vector<Vector2d> comb;
    for (int i = 0; i < 40; ++i) comb.emplace_back(0.01 * i, i % 2 == 0 ? 0.0 : 0.2);
    comb.emplace_back(0.4, 0.3);
    comb.emplace_back(0, 0.3);
    for (const auto& polygon :
         {Circle(3, 1), Circle(4, 1), Circle(60, 0.05), Circle(200, 1, 0.7), comb}) {
        const auto mesh = MeshPolygon(polygon, 0.02);
        ASSERT_TRUE(mesh);
        ExpectTriangulates(polygon, *mesh);
        EXPECT_LT(mesh->points.size(), 7 * polygon.size() + 10);
    }
}

TEST(PolygonMesh, ACircleIsFilledWithTrianglesOfTheSpacing) {
    const auto polygon = Circle(63, 0.1);  // edges of 1 cm
    const auto mesh = MeshPolygon(polygon, 0.01);
    ASSERT_TRUE(mesh);
    EXPECT_GT(mesh->points.size(), polygon.size() + 180);
    double longest = 0;
    for (const auto& t : mesh->triangles)
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, (mesh->points[t[k]] - mesh->points[t[(k + 1) % 3]]).norm());
    EXPECT_LT(longest, 0.022);
}

TEST(PolygonMesh, WhatIsNoPolygonIsRefused) {
    auto backwards = Circle(20, 1);
    std::ranges::reverse(backwards);
    const std::vector<Vector2d> eight{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, line{{0, 0}, {1, 0}, {2, 0}},
        touching{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}};
    EXPECT_FALSE(MeshPolygon(backwards, 0.1));
    EXPECT_FALSE(MeshPolygon(eight, 0.1));
    EXPECT_FALSE(MeshPolygon(line, 0.1));
    EXPECT_FALSE(MeshPolygon(touching, 0.1));
    // A spike through the side beyond, and a corner that is wound round twice.
    const std::vector<Vector2d> spike{{0, 0}, {4, 0}, {4, 2}, {2.1, 2}, {2, -1}, {1.9, 2}, {0, 2}},
        curl{{0, 0}, {4, 0}, {4, 3}, {1, 3}, {1, 1}, {3, 1}, {3, 4}, {0, 4}};
    EXPECT_FALSE(MeshPolygon(spike, 0.1));
    EXPECT_FALSE(MeshPolygon(curl, 0.1));
    EXPECT_FALSE(MeshPolygon(std::vector<Vector2d>{{0, 0}, {1, 0}}, 0.1));
    EXPECT_FALSE(MeshPolygon(std::vector<Vector2d>(5, {1, 1}), 0.1));
    EXPECT_FALSE(MeshPolygon(std::vector<Vector2d>{{0, 0}, {1, 0}, {NAN, 1}}, 0.1));
}

TEST(FairHeights, APlaneIsExactAndASphereNearlySo) {
    const auto polygon = Circle(63, 0.1, 0.05);
    const auto mesh = MeshPolygon(polygon, 0.01);
    ASSERT_TRUE(mesh);
    const auto check = [&](const auto& height, const auto& slope, double tolerance) {
        std::vector<double> rim;
        std::vector<Vector2d> slopes;
        for (const Vector2d& p : polygon) {
            rim.push_back(height(p));
            slopes.push_back(slope(p));
        }
        const auto heights = FairHeights(*mesh, rim, slopes);
        ASSERT_TRUE(heights);
        ASSERT_EQ(heights->size(), mesh->points.size());
        for (std::size_t i = 0; i < heights->size(); ++i)
            EXPECT_NEAR((*heights)[i], height(mesh->points[i]), tolerance);
    };
    check([](const Vector2d& p) { return 0.1 + 0.5 * p.x() - 0.2 * p.y(); },
          [](const Vector2d&) { return Vector2d(0.5, -0.2); }, 1e-9);
    const double r = 0.2;
    check([&](const Vector2d& p) { return std::sqrt(r * r - p.squaredNorm()); },
          [&](const Vector2d& p) { return Vector2d(-p / std::sqrt(r * r - p.squaredNorm())); },
          0.003);  // a flat lid would be 27 mm off
}

}  // namespace
}  // namespace tessera
