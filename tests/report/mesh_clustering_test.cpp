#include "report/mesh_clustering.h"

#include <gtest/gtest.h>

#include <limits>

#include "report/made_up_mesh.h"

namespace tessera {
namespace {

TEST(MeshClustering, KeepsTheBoundAndUsesMostOfIt) {
    const TriangleMesh mesh = BumpySheet(150, true);
    for (const std::size_t most : {10, 500, 5000, 30000}) {
        const ReducedMesh reduced = ReduceMesh(mesh, most);
        EXPECT_LE(reduced.mesh.triangles.size(), most);
        EXPECT_GE(reduced.mesh.triangles.size(), most / 4);
        EXPECT_GT(reduced.cell_m, 0);
        EXPECT_EQ(reduced.mesh.normals.size(), reduced.mesh.vertices.size());
        EXPECT_EQ(reduced.mesh.colours.size(), reduced.mesh.vertices.size());
        EXPECT_EQ(reduced.mesh.labels.size(), reduced.mesh.vertices.size());
    }
}

TEST(MeshClustering, StaysOnTheSurface) {
    const ReducedMesh reduced = ReduceMesh(BumpySheet(150), 8000);
    for (const Eigen::Vector3f& p : reduced.mesh.vertices) {
        const double u = p.x() + 1, v = p.y() - 3;
        // The mean of a curved piece lies beside it, by less than the cell squared.
        EXPECT_NEAR(p.z(), 0.3 * std::sin(2 * u) * std::cos(3 * v),
                    2 * reduced.cell_m * reduced.cell_m);
    }
}

TEST(MeshClustering, ASmallMeshIsLeftAsItIs) {
    const TriangleMesh mesh = BumpySheet(10);
    const ReducedMesh reduced = ReduceMesh(mesh, mesh.triangles.size());
    EXPECT_EQ(reduced.cell_m, 0);
    EXPECT_EQ(reduced.mesh.vertices, mesh.vertices);
    EXPECT_EQ(reduced.mesh.triangles, mesh.triangles);
}

TEST(MeshClustering, MergesIntoMeans) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {0.2f, 0, 0}, {5, 0, 0}, {0, 5, 0}};
    mesh.colours = {{10, 0, 0}, {21, 0, 0}, {1, 2, 3}, {4, 5, 6}};
    mesh.labels = {{3, 1}, {4, 2}, {}, {}};
    mesh.triangles = {{0, 2, 3}, {0, 1, 3}};
    const TriangleMesh merged = ClusterVertices(mesh, 1);
    ASSERT_EQ(merged.vertices.size(), 3u);
    ASSERT_EQ(merged.triangles.size(), 1u);  // the other one became a line
    const std::uint32_t v = merged.triangles[0][0];
    EXPECT_FLOAT_EQ(merged.vertices[v].x(), 0.1f);
    EXPECT_EQ(merged.colours[v], (Rgb8{16, 0, 0}));
    EXPECT_EQ(merged.labels[v], (VertexLabel{3, 1}));
}

TEST(MeshClustering, NotFiniteVerticesGoWithTheirTriangles) {
    TriangleMesh mesh = BumpySheet(40);
    mesh.vertices[100].y() = std::numeric_limits<float>::infinity();
    const ReducedMesh reduced = ReduceMesh(mesh, 1000);
    EXPECT_LE(reduced.mesh.triangles.size(), 1000u);
    for (const Eigen::Vector3f& p : reduced.mesh.vertices) EXPECT_TRUE(p.allFinite());
}

TEST(MeshClustering, PointsAreThinned) {
    TriangleMesh points = BumpySheet(50);
    points.triangles.clear();
    const ReducedMesh reduced = ReduceMesh(points, 1000);
    EXPECT_LE(reduced.mesh.vertices.size(), 1000u);
    EXPECT_GE(reduced.mesh.vertices.size(), 500u);
    EXPECT_EQ(reduced.mesh.colours.size(), reduced.mesh.vertices.size());
}

}  // namespace
}  // namespace tessera
