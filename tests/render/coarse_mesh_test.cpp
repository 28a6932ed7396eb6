#include "render/coarse_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace tessera {
namespace {

// A flat square of 1 m, `n` x `n` quads.
TriangleMesh Square(int n) {
    TriangleMesh mesh;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) {
            mesh.vertices.emplace_back(static_cast<float>(x) / static_cast<float>(n),
                                       static_cast<float>(y) / static_cast<float>(n), 0.5f);
            mesh.colours.push_back({static_cast<std::uint8_t>(x % 256), 0, 0});
        }
    const auto at = [n](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
            mesh.triangles.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    return mesh;
}

double Area(const TriangleMesh& mesh) {
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        area +=
            0.5 *
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).z();
    return area;
}

TEST(CoarseMesh, KeepsTheFirstVertexOfEachCell) {
    // Cells of two quads, plus the far edges.
    const TriangleMesh coarse = CoarseMesh(Square(8), 0.25);
    ASSERT_EQ(coarse.vertices.size(), 25u);
    EXPECT_EQ(coarse.triangles.size(), 32u);
    EXPECT_TRUE(coarse.normals.empty());
    ASSERT_EQ(coarse.colours.size(), 25u);
    EXPECT_EQ(coarse.colours[1].r, 2);
    EXPECT_NEAR(Area(coarse), 1, 1e-6) << "no holes, no flipped triangles";
}

TEST(CoarseMesh, HasAboutAsManyTrianglesAsAskedFor) {
    const TriangleMesh mesh = Square(100);
    for (const std::size_t most : {2000u, 500u}) {
        const TriangleMesh coarse = CoarseMeshOf(mesh, most);
        EXPECT_LE(coarse.triangles.size(), most);
        EXPECT_GT(coarse.triangles.size(), most / 4);
        EXPECT_NEAR(Area(coarse), 1, 0.2) << "up to one cell less on two sides";
    }
}

}  // namespace
}  // namespace tessera
