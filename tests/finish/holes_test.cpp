#include "finish/holes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>

#include "finish/boundary_loops.h"
#include "finish/mesh_edges.h"
#include "finish/meshes.h"

namespace tessera {
namespace {

using testing_support::Append;
using testing_support::Sphere;
using testing_support::Square;

// Takes away the triangles whose middle `inside` says is in the hole.
template <class Inside>
TriangleMesh WithHole(TriangleMesh mesh, const Inside& inside) {
    std::erase_if(mesh.triangles, [&](const auto& t) {
        return inside(
            Eigen::Vector3f((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3));
    });
    DropUnusedVertices(mesh);
    return mesh;
}

// A plane of a metre, cells of a centimetre, with a round hole.
TriangleMesh PlaneWithHole(float radius_m) {
    return WithHole(Square({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f, 100),
                    [&](const Eigen::Vector3f& p) { return p.norm() < radius_m; });
}

double AreaOf(const TriangleMesh& mesh, std::size_t first = 0) {
    double area = 0;
    for (std::size_t t = first; t < mesh.triangles.size(); ++t)
        area += static_cast<double>(AreaNormal(mesh, mesh.triangles[t]).norm());
    return area;
}

// A camera in front of the plane's hole that measures `beyond_m` behind it.
FrameEvidence Looking(double beyond_m) {
    Frame frame;
    frame.T_world_camera = Eigen::Isometry3d::Identity();
    frame.T_world_camera->translation() = Eigen::Vector3d(0, 0, -1);
    frame.depth_m = DepthImage(160, 120, static_cast<float>(1 + beyond_m));
    FrameEvidence evidence;
    for (int i = 0; i < 3; ++i) evidence.Add({160, 120, 150, 150, 79.5, 59.5}, frame);
    return evidence;
}

TEST(Holes, ASmallHoleInAPlaneIsClosedALargeOneIsNot) {
    TriangleMesh mesh = PlaneWithHole(0.03f);
    const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
    const ClosedHoles holes = CloseHoles(mesh, 0.1, {});
    EXPECT_EQ(holes.loops, 2u);
    EXPECT_EQ(holes.outer, 1u);
    EXPECT_EQ(holes.closed, 1u);
    EXPECT_NEAR(holes.area_m2, std::numbers::pi * 0.03 * 0.03, 4e-4);
    EXPECT_GT(mesh.vertices.size(), vertices);
    EXPECT_NEAR(AreaOf(mesh), 1, 1e-5);
    for (const Eigen::Vector3f& v : mesh.vertices) EXPECT_NEAR(v.z(), 0, 1e-6);
    for (std::size_t t = triangles; t < mesh.triangles.size(); ++t)
        EXPECT_LT(AreaNormal(mesh, mesh.triangles[t]).z(), 0);  // as the plane
    EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
    EXPECT_NEAR((mesh.normals.back() - Eigen::Vector3f(0, 0, -1)).norm(), 0, 1e-5);
    EXPECT_EQ(mesh.colours.back(), (Rgb8{128, 128, 128}));
    EXPECT_EQ(FindBoundaryLoops(mesh).size(), 1u);

    TriangleMesh large = PlaneWithHole(0.25f);
    const std::size_t before = large.triangles.size();
    EXPECT_EQ(CloseHoles(large, 0.1, {}).large, 1u);
    EXPECT_EQ(large.triangles.size(), before);
    EXPECT_EQ(CloseHoles(large, 0.6, {}).closed, 1u);
    EXPECT_NEAR(AreaOf(large), 1, 1e-5);
}

TEST(Holes, WhatFramesLookThroughStaysOpen) {
    TriangleMesh mesh = PlaneWithHole(0.03f);
    EXPECT_EQ(CloseHoles(mesh, 0.1, Looking(0.3)).through, 1u);
    EXPECT_EQ(CloseHoles(mesh, 0.1, Looking(0)).closed, 1u);
}

// The rim's normals say nothing; the frames' depth does.
TEST(Holes, NoiseIsClosedWhereFramesHaveMeasuredASurface) {
    const auto noisy = [] {
        TriangleMesh mesh = PlaneWithHole(0.03f);
        for (std::size_t v = 0; v < mesh.normals.size(); ++v)
            mesh.normals[v] = Eigen::Vector3f(v % 2 == 0 ? 2 : -2, 0, -1).normalized();
        return mesh;
    };
    TriangleMesh mesh = noisy();
    EXPECT_EQ(CloseHoles(mesh, 0.1, {}).uneven, 1u);
    EXPECT_EQ(CloseHoles(mesh, 0.1, Looking(-0.3)).uneven, 1u);  // something hides it
    EXPECT_EQ(CloseHoles(mesh, 0.1, Looking(0.3)).through, 1u);
    EXPECT_EQ(CloseHoles(mesh, 0.1, Looking(0)).closed, 1u);
    EXPECT_NEAR(AreaOf(mesh), 1, 1e-5);
}

TEST(Holes, ASphereIsRounded) {
    TriangleMesh mesh = WithHole(Sphere(0.1f, 40), [](const Eigen::Vector3f& p) {
        return (p - Eigen::Vector3f(0.1f, 0, 0)).norm() < 0.045f;
    });
    const std::size_t measured = mesh.vertices.size();
    const ClosedHoles holes = CloseHoles(mesh, 0.1, {});
    EXPECT_EQ(holes.closed, 1u);
    EXPECT_TRUE(FindBoundaryLoops(mesh).empty());
    // A flat lid would be 10 mm too low.
    for (std::size_t v = measured; v < mesh.vertices.size(); ++v) {
        EXPECT_NEAR(mesh.vertices[v].norm(), 0.1, 0.001);
        EXPECT_GT(mesh.normals[v].dot(mesh.vertices[v].normalized()), 0.95f);
    }
    EXPECT_GT(mesh.vertices.size(), measured + 50);
}

TEST(Holes, ACubesMissingCornerIsClosed) {
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            Eigen::Vector3f out = Eigen::Vector3f::Zero(), right = out;
            out[axis] = side;
            right[(axis + 1) % 3] = 1;
            const Eigen::Vector3f down = out.cross(right);
            Append(mesh, Square(0.1f * (out - right + (-1) * down), right, down, 0.2f, 20));
        }
    // The faces' vertices meet.
    std::vector<std::uint32_t> name(mesh.vertices.size());
    for (std::uint32_t v = 0; v < name.size(); ++v)
        for (name[v] = 0; (mesh.vertices[name[v]] - mesh.vertices[v]).norm() > 1e-5f;) ++name[v];
    for (auto& triangle : mesh.triangles) {
        for (std::uint32_t& v : triangle) v = name[v];
        std::swap(triangle[1], triangle[2]);
    }
    for (Eigen::Vector3f& n : mesh.normals) n.setZero();
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle) mesh.normals[v] += AreaNormal(mesh, triangle);
    for (Eigen::Vector3f& n : mesh.normals) n.normalize();
    ASSERT_GT(mesh.normals[mesh.triangles[0][0]].dot(mesh.vertices[mesh.triangles[0][0]]), 0);
    mesh = WithHole(std::move(mesh), [](const Eigen::Vector3f& p) {
        return (p - Eigen::Vector3f(0.1f, 0.1f, 0.1f)).norm() < 0.035f;
    });
    ASSERT_EQ(FindBoundaryLoops(mesh).size(), 1u);
    const std::size_t measured = mesh.vertices.size();
    EXPECT_EQ(CloseHoles(mesh, 0.1, {}).closed, 1u);
    EXPECT_TRUE(FindBoundaryLoops(mesh).empty());
    for (std::size_t v = measured; v < mesh.vertices.size(); ++v) {
        EXPECT_LT(mesh.vertices[v].maxCoeff(), 0.105f);  // no more than the corner
        EXPECT_GT(mesh.vertices[v].sum(), 0.25f);
    }
}

// A silhouette: the surface's own end, seen from where it turns away.
TEST(Holes, SheetsAreNotJoinedAndAnOpenBackStaysOpen) {
    TriangleMesh sheets = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.05f, 10);
    Append(sheets, Square({0, 0, 0.01f}, {1, 0, 0}, {0, 1, 0}, 0.05f, 10));
    const std::size_t triangles = sheets.triangles.size();
    EXPECT_EQ(CloseHoles(sheets, 0.2, {}).outer, 2u);
    EXPECT_EQ(sheets.triangles.size(), triangles);
    // Half of a ball: the rim's normals lie in the plane of its loop.
    TriangleMesh half =
        WithHole(Sphere(0.04f, 20), [](const Eigen::Vector3f& p) { return p.x() < 0; });
    EXPECT_EQ(CloseHoles(half, 0.2, {}).closed, 0u);
}

TEST(BoundaryLoops, AVertexWhereALoopMeetsItselfSplitsIt) {
    // Two holes of one cell each that touch in a corner.
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f, 4);
    mesh = WithHole(std::move(mesh), [](const Eigen::Vector3f& p) {
        return (p.x() > 0.25f && p.x() < 0.5f && p.y() > 0.25f && p.y() < 0.5f) ||
               (p.x() > 0.5f && p.x() < 0.75f && p.y() > 0.5f && p.y() < 0.75f);
    });
    std::vector<std::size_t> lengths;
    for (const BoundaryLoop& loop : FindBoundaryLoops(mesh)) lengths.push_back(loop.size());
    std::ranges::sort(lengths);
    EXPECT_EQ(lengths, (std::vector<std::size_t>{4, 4, 16}));
    EXPECT_EQ(CloseHoles(mesh, 0.5, {}).closed, 2u);
}

TEST(Holes, HostileMeshesTakeLittle) {
    // A strip whose border has a million edges.
    TriangleMesh strip;
    constexpr std::uint32_t kSteps = 500000;
    for (std::uint32_t i = 0; i <= kSteps; ++i)
        for (const float y : {0.0f, 1e-3f}) {
            const auto angle = static_cast<float>(i * (2 * std::numbers::pi / (kSteps + 9.0)));
            strip.vertices.push_back({(1 + y) * std::cos(angle), (1 + y) * std::sin(angle), 0});
            strip.normals.push_back({0, 0, 1});
        }
    for (std::uint32_t v = 0; v + 3 < strip.vertices.size(); v += 2) {
        strip.triangles.push_back({v, v + 1, v + 2});
        strip.triangles.push_back({v + 1, v + 3, v + 2});
    }
    // Triangles without area, of one vertex, turned about, and three on an edge.
    strip.triangles.push_back({0, 0, 0});
    strip.triangles.push_back({4, 4, 6});
    strip.triangles.push_back({8, 9, 10});
    strip.triangles.push_back({9, 8, 10});
    strip.vertices[100] = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
    const std::clock_t start = std::clock();  // of the processor: others may use it, too
    const std::size_t before = strip.triangles.size();
    EXPECT_LE(CloseHoles(strip, 10, {}).closed, 4u);
    EXPECT_LE(strip.triangles.size(), before + 20);
    EXPECT_LT(std::clock() - start, 10 * CLOCKS_PER_SEC);
}

// Every loop is as long as is closed at all, and as jagged as can be.
TEST(Holes, ManyEdgesTakeMemoryInProportion) {
    TriangleMesh star;
    constexpr std::uint32_t kEdges = 1000;
    for (std::uint32_t i = 0; i < kEdges; ++i) {
        const double angle = i * (2 * std::numbers::pi / kEdges), radius = i % 2 == 0 ? 0.2 : 0.05;
        for (const double r : {radius, 0.3})
            star.vertices.push_back({static_cast<float>(r * std::cos(angle)),
                                     static_cast<float>(r * std::sin(angle)), 0});
    }
    star.normals.assign(star.vertices.size(), {0, 0, 1});
    for (std::uint32_t i = 0; i < kEdges; ++i) {
        const std::uint32_t a = 2 * i, b = (a + 2) % (2 * kEdges);
        star.triangles.push_back({a, a + 1, b + 1});
        star.triangles.push_back({a, b + 1, b});
    }
    const std::size_t before = star.triangles.size();
    EXPECT_EQ(CloseHoles(star, 0.5, {}).closed, 1u);
    EXPECT_LT(star.triangles.size(), before + 15 * kEdges);
}

}  // namespace
}  // namespace tessera
