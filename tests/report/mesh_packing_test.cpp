#include "report/mesh_packing.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "report/made_up_mesh.h"
#include "report/unpacked_mesh.h"

namespace tessera {
namespace {

TEST(MeshPacking, EachCornerComesBackWithinHalfAStep) {
    const TriangleMesh mesh = BumpySheet(40, true);
    const PackedMesh packed = PackMesh(mesh);
    const std::vector<std::uint32_t> corners = UnpackCorners(packed);
    ASSERT_EQ(packed.triangle_count, mesh.triangles.size());
    ASSERT_EQ(corners.size(), 3 * mesh.triangles.size());
    ASSERT_EQ(packed.vertices.size(), kPackedVertexBytes * packed.vertex_count);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        ASSERT_LT(corners[i], packed.vertex_count);
        const UnpackedVertex vertex = UnpackVertex(packed, corners[i]);
        const std::uint32_t v = mesh.triangles[i / 3][i % 3];
        const Eigen::Vector3d apart =
            (vertex.position - mesh.vertices[v].cast<double>()).cwiseAbs();
        EXPECT_TRUE((apart.array() <= 0.5001 * packed.step.array()).all()) << i;
        EXPECT_EQ(vertex.colour, mesh.colours[v]);
        EXPECT_EQ(vertex.class_id, mesh.labels[v].class_id);
        // 127 steps per axis: the direction is within 0.95 degrees.
        EXPECT_GT(vertex.normal.dot(mesh.normals[v].cast<double>()), std::cos(0.95 * 0.0174533));
    }
}

TEST(MeshPacking, StepsFillTheBox) {
    const PackedMesh packed = PackMesh(BumpySheet(10));
    EXPECT_NEAR(packed.low.x(), -1, 1e-9);
    EXPECT_NEAR(packed.low.y(), 3, 1e-9);
    EXPECT_NEAR(packed.step.x(), 4.0 / 65535, 1e-12);
}

TEST(MeshPacking, ComputesNormalsWhereTheMeshHasNone) {
    const TriangleMesh with = BumpySheet(60, true), without = BumpySheet(60);
    const PackedMesh a = PackMesh(with), b = PackMesh(without);
    double worst = 1;
    for (std::size_t v = 0; v < a.vertex_count; ++v)
        worst = std::min(worst, UnpackVertex(a, v).normal.dot(UnpackVertex(b, v).normal));
    EXPECT_GT(worst, 0.99);
}

TEST(MeshPacking, OctahedralCodesOfAllDirections) {
    for (double z = -1; z <= 1; z += 0.05)
        for (double angle = 0; angle < 6.3; angle += 0.1) {
            const double r = std::sqrt(std::max(0.0, 1 - z * z));
            const Eigen::Vector3d n(r * std::cos(angle), r * std::sin(angle), z);
            TriangleMesh point;
            point.vertices = {Eigen::Vector3f::Zero()};
            point.normals = {n.cast<float>()};
            EXPECT_GT(UnpackVertex(PackMesh(point), 0).normal.dot(n), 0.9998) << n.transpose();
        }
}

TEST(MeshPacking, LeavesOutWhatIsNotFiniteOrNotUsed) {
    TriangleMesh mesh = BumpySheet(4);
    const std::size_t all = mesh.vertices.size();
    mesh.vertices.emplace_back(99, 99, 99);  // of no triangle
    mesh.colours.emplace_back();
    mesh.labels.emplace_back();
    mesh.vertices[0].x() = std::numeric_limits<float>::quiet_NaN();  // of one triangle, a corner
    const PackedMesh packed = PackMesh(mesh);
    EXPECT_EQ(packed.triangle_count, mesh.triangles.size() - 1);
    EXPECT_EQ(packed.vertex_count, all - 1);
    EXPECT_LT(packed.low.x() + 65535 * packed.step.x(), 4);
}

TEST(MeshPacking, PointsWithoutTriangles) {
    TriangleMesh points = BumpySheet(8);
    points.triangles.clear();
    points.colours.clear();
    points.labels.clear();
    const PackedMesh packed = PackMesh(points);
    EXPECT_EQ(packed.vertex_count, points.vertices.size());
    EXPECT_TRUE(packed.corners.empty());
    EXPECT_LT((UnpackVertex(packed, 5).position - points.vertices[5].cast<double>()).norm(), 1e-4);
}

TEST(MeshPacking, AFlatOrEmptyMeshHasASteps) {
    EXPECT_EQ(PackMesh({}).vertex_count, 0u);
    TriangleMesh flat = BumpySheet(2);
    for (Eigen::Vector3f& p : flat.vertices) p.z() = 1;
    const PackedMesh packed = PackMesh(flat);
    EXPECT_GT(packed.step.z(), 0);
    EXPECT_DOUBLE_EQ(UnpackVertex(packed, 3).position.z(), 1);
}

TEST(MeshPacking, MostCornersTakeOneOrTwoBytes) {
    const PackedMesh packed = PackMesh(BumpySheet(200));
    EXPECT_LT(packed.corners.size(), 2 * 3 * packed.triangle_count);
}

}  // namespace
}  // namespace tessera
