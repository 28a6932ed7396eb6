#include "finish/crop.h"

#include <gtest/gtest.h>

#include "finish/mesh_edges.h"
#include "finish/meshes.h"

namespace tessera {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

double AreaOf(const TriangleMesh& mesh) {
    double area_m2 = 0;
    for (const auto& triangle : mesh.triangles)
        area_m2 += static_cast<double>(AreaNormal(mesh, triangle).norm());
    return area_m2;
}

std::size_t BorderEdges(const TriangleMesh& mesh) {
    std::size_t edges = 0;
    for (const auto& neighbours : TriangleNeighbours(mesh))
        for (const std::uint32_t n : neighbours) edges += n == kNoTriangle;
    return edges;
}

// A slice of a ball between two heights, whose area is 2 pi r h; cut off on no other side.
TEST(CropMesh, CutsAlongTheBox) {
    TriangleMesh ball = testing_support::Sphere(0.5f, 60);
    for (std::size_t i = 0; i < ball.vertices.size(); ++i)
        ball.colours[i].r = static_cast<std::uint8_t>(128 + 200 * ball.vertices[i].z());
    const double whole_m2 = AreaOf(ball);
    TriangleMesh below = ball, above = ball;
    ASSERT_TRUE(
        CropMesh(Eigen::AlignedBox3d(Vector3d(-1, -1, -1), Vector3d(1, 1, -0.113)), below).ok());
    ASSERT_TRUE(
        CropMesh(Eigen::AlignedBox3d(Vector3d(-1, -1, 0.217), Vector3d(1, 1, 1)), above).ok());
    ASSERT_TRUE(
        CropMesh(Eigen::AlignedBox3d(Vector3d(-1, -1, -0.113), Vector3d(1, 1, 0.217)), ball).ok());
    EXPECT_NEAR(AreaOf(ball), 2 * 3.14159265 * 0.5 * 0.33, 2e-3);  // facets of 3 degrees
    EXPECT_NEAR(AreaOf(below) + AreaOf(ball) + AreaOf(above), whole_m2, 1e-5);
    int on_low = 0, on_high = 0;
    for (std::size_t i = 0; i < ball.vertices.size(); ++i) {
        const Vector3f& v = ball.vertices[i];
        ASSERT_GE(v.z(), -0.113f);
        ASSERT_LE(v.z(), 0.217f);
        on_low += v.z() == -0.113f;
        on_high += v.z() == 0.217f;
        EXPECT_LT((ball.normals[i] - v.normalized()).norm(), 0.01f);
        EXPECT_NEAR(ball.colours[i].r, 128 + 200 * v.z(), 1.5f);
    }
    EXPECT_GT(on_low, 100);
    EXPECT_GT(on_high, 100);
    // Two rims and no crack.
    EXPECT_EQ(BorderEdges(ball), static_cast<std::size_t>(on_low + on_high));
    for (const auto& triangle : ball.triangles) {
        const Vector3f normal = AreaNormal(ball, triangle);
        EXPECT_GE(normal.dot(ball.vertices[triangle[0]]), 0) << "turned over";
    }
}

TEST(CropMesh, LeavesWhatLiesInsideAndOnTheSides) {
    TriangleMesh square = testing_support::Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 4);
    square.labels.resize(square.vertices.size());
    const TriangleMesh before = square;
    ASSERT_TRUE(CropMesh(Eigen::AlignedBox3d(Vector3d(0, 0, -1), Vector3d(1, 1, 1)), square).ok());
    EXPECT_EQ(square.triangles, before.triangles);
    EXPECT_EQ(square.vertices, before.vertices);
    // Along the grid's own lines: no new vertex, no sliver.
    ASSERT_TRUE(
        CropMesh(Eigen::AlignedBox3d(Vector3d(0.25, 0, -1), Vector3d(0.75, 1, 1)), square).ok());
    EXPECT_EQ(square.triangles.size(), 16u);
    EXPECT_EQ(square.vertices.size(), 15u);
    EXPECT_EQ(square.labels.size(), 15u);
    EXPECT_NEAR(AreaOf(square), 0.5, 1e-6);
}

TEST(CropMesh, NothingLeftIsAnErrorThatSaysWhereTheMeshIs) {
    TriangleMesh square = testing_support::Square({0, 0, 2}, {1, 0, 0}, {0, 1, 0}, 1, 4);
    const Status status =
        CropMesh(Eigen::AlignedBox3d(Vector3d(0, 0, 3), Vector3d(1, 1, 4)), square);
    EXPECT_NE(status.message().find("0.00 0.00 2.00 1.00 1.00 2.00"), std::string::npos)
        << status.message();
    TriangleMesh empty;
    EXPECT_FALSE(CropMesh(Eigen::AlignedBox3d(Vector3d(0, 0, 3), Vector3d(1, 1, 4)), empty).ok());
}

}  // namespace
}  // namespace tessera
