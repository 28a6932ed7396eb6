#include "finish/charts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "finish/atlas.h"
#include "finish/cover.h"
#include "finish/meshes.h"

namespace tessera {
namespace {

using Eigen::Vector3f;
using testing_support::Append;
using testing_support::Sphere;
using testing_support::Square;

// Each triangle in one chart, in its box, and no cell covered twice.
void ExpectSound(const TriangleMesh& mesh, const std::vector<Chart>& charts, float cell_m) {
    std::vector<int> uses(mesh.triangles.size());
    for (const Chart& chart : charts) {
        EXPECT_NEAR(chart.right.dot(chart.down), 0, 1e-5f);
        std::map<std::pair<int, int>, int> covered;
        for (const std::uint32_t t : chart.triangles) {
            ++uses[t];
            std::array<Eigen::Vector2f, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = chart.Place(mesh.vertices[mesh.triangles[t][k]]);
                EXPECT_GE(corners[k].minCoeff(), -1e-5f);
                EXPECT_LE((corners[k] - chart.size_m).maxCoeff(), 1e-5f);
                corners[k] = corners[k] / cell_m + Eigen::Vector2f::Constant(0.5f);
            }
            ForEachCovered(corners, -0.1f, [&](int x, int y, const auto&) { ++covered[{x, y}]; });
        }
        for (const auto& [at, count] : covered) EXPECT_EQ(count, 1) << at.first << " " << at.second;
    }
    EXPECT_TRUE(std::ranges::all_of(uses, [](int n) { return n == 1; }));
}

TEST(Charts, AFlatSquareIsOneTight) {
    const Vector3f right = Vector3f(2, 1, 0.5f).normalized(), down = right.unitOrthogonal();
    const TriangleMesh mesh = Square({1, 2, 3}, right, down, 0.5f, 6);
    const std::vector<Chart> charts = CutCharts(mesh, {.cell_m = 0.01});
    ASSERT_EQ(charts.size(), 1u);
    ExpectSound(mesh, charts, 0.01f);
    // The box is turned until it is small: within the step of 7.5 degrees, 14 % of the area.
    EXPECT_LT(charts[0].size_m.prod(), 1.3f * 0.25f);
    // Right and down as seen from outside.
    EXPECT_NEAR(charts[0].down.cross(charts[0].right).dot(mesh.normals[0]), 1, 1e-4f);
}

TEST(Charts, ASphereFallsIntoAFewWithoutOverlap) {
    const TriangleMesh mesh = Sphere(0.4f, 24);
    const std::vector<Chart> charts = CutCharts(mesh, {.cell_m = 0.004});
    EXPECT_GE(charts.size(), 4u);
    EXPECT_LE(charts.size(), 40u);
    ExpectSound(mesh, charts, 0.004f);
}

// A strip that winds up: its turns lie over each other as seen along their common normal.
TEST(Charts, TurnsOfAHelixAreTakenApart) {
    TriangleMesh mesh;
    constexpr std::uint32_t kSteps = 80;
    for (std::uint32_t i = 0; i <= kSteps; ++i) {
        const float angle = 4 * 3.14159265f * static_cast<float>(i) / kSteps;
        const float height = 0.1f * static_cast<float>(i) / kSteps;
        for (const float radius : {0.2f, 0.4f}) {
            mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
            mesh.normals.emplace_back(0, 0, 1);
            mesh.colours.push_back({});
        }
    }
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const std::uint32_t a = 2 * i;
        mesh.triangles.push_back({a, a + 1, a + 3});
        mesh.triangles.push_back({a, a + 3, a + 2});
    }
    const std::vector<Chart> charts = CutCharts(mesh, {.cell_m = 0.01});
    EXPECT_GE(charts.size(), 2u);
    ExpectSound(mesh, charts, 0.01f);
}

TEST(Charts, WhatIsLargeIsCutAndWhatHasNoAreaHasAPlace) {
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4.0f, 40);
    mesh.triangles.push_back({0, 0, 1});
    const std::vector<Chart> charts = CutCharts(mesh, {.cell_m = 0.02});
    ExpectSound(mesh, charts, 0.02f);
    EXPECT_GE(charts.size(), 9u);
    for (const Chart& chart : charts) EXPECT_LE(chart.size_m.maxCoeff(), 1.5f + 1e-4f);
}

// A triangle of a kilometre takes no grid of a kilometre.
TEST(Charts, AHugeTriangleIsAChartByItself) {
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1f, 1);
    mesh.vertices.push_back({0, -1000, 0});
    mesh.normals.push_back(mesh.normals[0]);
    mesh.colours.push_back({});
    mesh.triangles.insert(mesh.triangles.begin(), {0, 1, 4});
    const std::vector<Chart> charts = CutCharts(mesh, {.cell_m = 0.002});
    ASSERT_EQ(charts.size(), 2u);
    EXPECT_EQ(charts[0].triangles, std::vector<std::uint32_t>{0});
    EXPECT_EQ(charts[1].triangles.size(), 2u);
    EXPECT_FALSE(PackCharts({Chart{{}, {}, {}, {}, {1e30f, 1}}}, 0.002, 4096).ok());
}

}  // namespace
}  // namespace tessera
