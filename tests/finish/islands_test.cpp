#include "finish/islands.h"

#include <gtest/gtest.h>

#include "finish/mesh_edges.h"
#include "finish/meshes.h"

namespace tessera {
namespace {

using testing_support::Append;
using testing_support::Sphere;
using testing_support::Square;

TEST(Islands, WhatIsTooSmallGoesWithItsVertices) {
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f, 10);
    const TriangleMesh large = mesh;
    Append(mesh, Square({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0.2f, 2));   // 0.04 m2
    Append(mesh, Square({0, 0, 2}, {1, 0, 0}, {0, 1, 0}, 0.05f, 3));  // 0.0025 m2
    const TriangleMesh whole = mesh;
    const RemovedIslands removed = RemoveIslands(mesh, 0.01);
    EXPECT_EQ(removed.islands, 1u);
    EXPECT_EQ(removed.triangles, 18u);
    EXPECT_NEAR(removed.area_m2, 0.0025, 1e-6);
    EXPECT_EQ(mesh.triangles.size(), whole.triangles.size() - 18);
    EXPECT_EQ(mesh.vertices.size(), whole.vertices.size() - 16);
    EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
    EXPECT_EQ(mesh.colours.size(), mesh.vertices.size());
    RemoveIslands(mesh, 0.05);
    EXPECT_EQ(mesh.vertices, large.vertices);
    EXPECT_EQ(mesh.triangles, large.triangles);
}

TEST(Islands, TheLargestStaysHoweverSmall) {
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.01f, 1);
    EXPECT_EQ(RemoveIslands(mesh, 1).islands, 0u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    TriangleMesh empty;
    EXPECT_EQ(RemoveIslands(empty, 1).islands, 0u);
}

TEST(Islands, WhereDepthIsNoisyLargerOnesGo) {
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f, 10);
    Append(mesh, Square({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0.2f, 2));  // 0.04 m2
    Append(mesh, Square({0, 0, 2}, {1, 0, 0}, {0, 1, 0}, 0.2f, 2));
    std::vector<float> sigmas_m(mesh.vertices.size(), 0.002f);
    for (std::size_t v = 130; v < sigmas_m.size(); ++v) sigmas_m[v] = 0.005f;  // of the last
    EXPECT_EQ(RemoveIslands(mesh, 0.01, sigmas_m).islands, 1u);
    EXPECT_EQ(mesh.vertices.size(), 130u);
    EXPECT_EQ(sigmas_m, std::vector<float>(130, 0.002f));
}

// Pieces that meet in a vertex only are two.
TEST(Islands, AVertexDoesNotJoin) {
    TriangleMesh mesh = Square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f, 1);
    mesh.vertices.insert(mesh.vertices.end(), {{1.1f, 1, 0}, {1, 1.1f, 0}});
    mesh.normals.resize(6, mesh.normals.front());
    mesh.colours.resize(6);
    mesh.triangles.push_back({3, 5, 4});
    EXPECT_EQ(RemoveIslands(mesh, 0.01).islands, 1u);
}

TEST(MeshEdges, NeighboursShareTheEdge) {
    const TriangleMesh mesh = Sphere(1, 6);
    const auto neighbours = TriangleNeighbours(mesh);
    for (std::size_t t = 0; t < neighbours.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t n = neighbours[t][k];
            ASSERT_NE(n, kNoTriangle);  // a sphere has no border
            int shared = 0;
            for (const std::uint32_t v : mesh.triangles[n])
                shared += v == mesh.triangles[t][k] || v == mesh.triangles[t][(k + 1) % 3];
            EXPECT_EQ(shared, 2);
        }
}

}  // namespace
}  // namespace tessera
