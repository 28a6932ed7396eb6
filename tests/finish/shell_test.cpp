#include "finish/shell.h"

#include <gtest/gtest.h>

#include <map>

#include "finish/meshes.h"

namespace tessera {
namespace {

using testing_support::Append;
using testing_support::Sphere;
using testing_support::Square;

// Each edge is there as often in each direction: once, or at most so often.
bool IsClosed(const TriangleMesh& mesh, int most = 1) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    return std::ranges::all_of(edges, [&](const auto& edge) {
        const auto back = edges.find({edge.first.second, edge.first.first});
        return edge.second <= most && back != edges.end() && back->second == edge.second;
    });
}

double Volume(const TriangleMesh& mesh) {
    double volume = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        volume +=
            static_cast<double>(mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6);
    return volume;
}

TEST(Shell, ASquareBecomesAPlate) {
    const TriangleMesh square = Square({1, 2, 3}, {1, 0, 0}, {0, 1, 0}, 0.5f, 5);
    EXPECT_FALSE(IsClosed(square));
    const Shell shell = MakeShell(square, 0.02);
    EXPECT_TRUE(IsClosed(shell.mesh));
    EXPECT_EQ(shell.open_pieces, 1u);
    EXPECT_EQ(shell.closed_pieces, 0u);
    EXPECT_NEAR(Volume(shell.mesh), 0.5 * 0.5 * 0.02, 1e-5);
    EXPECT_EQ(shell.mesh.triangles.size(), 2 * 50 + 2 * 20u);
    EXPECT_EQ(shell.mesh.normals.size(), shell.mesh.vertices.size());
    EXPECT_EQ(shell.mesh.colours.size(), shell.mesh.vertices.size());
}

TEST(Shell, AClosedSurfaceStaysAndAnOpenOneBesideItDoesNot) {
    TriangleMesh mesh = Sphere(0.1f, 12);
    const std::size_t sphere = mesh.triangles.size();
    Append(mesh, Square({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.5f, 1));
    const Shell shell = MakeShell(mesh, 0.01);
    EXPECT_EQ(shell.closed_pieces, 1u);
    EXPECT_EQ(shell.open_pieces, 1u);
    EXPECT_EQ(shell.mesh.triangles.size(), sphere + 4 + 8);
    EXPECT_TRUE(IsClosed(shell.mesh));
}

TEST(Shell, WhatDoesNotFitTogetherIsTakenApart) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0},  {0, 1, 0},  {0, -1, 0},
                     {0, 0, 1}, {-1, 0, 0}, {-1, -1, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4},  // three on an edge
                      {0, 5, 6},                        // only a vertex in common
                      {2, 1, 0}, {1, 2, 4},             // the first one turned about
                      {0, 0, 1}, {3, 3, 3}};            // no triangles
    const Shell shell = MakeShell(mesh, 0.05);
    EXPECT_TRUE(IsClosed(shell.mesh, 2));
    EXPECT_GE(shell.mesh.triangles.size(), 12u);
    EXPECT_TRUE(MakeShell({}, 0.05).mesh.triangles.empty());
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}};  // they disagree about inside and outside
    const Shell plates = MakeShell(mesh, 0.05);
    EXPECT_TRUE(IsClosed(plates.mesh));
    EXPECT_EQ(plates.open_pieces, 2u);
}

}  // namespace
}  // namespace tessera
