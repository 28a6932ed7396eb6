#include "render/triangle_scene.h"

#include <gtest/gtest.h>

#include "render/closest_point.h"
#include "render/random_mesh.h"

namespace tessera {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3d Vertex(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t corner) {
    return mesh.vertices[mesh.triangles[triangle][corner]].cast<double>();
}

// A slow, straightforward reference.
double NearestByHand(const TriangleMesh& mesh, const Vector3d& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        nearest = std::min(
            nearest,
            (ClosestOnTriangle(p, Vertex(mesh, i, 0), Vertex(mesh, i, 1), Vertex(mesh, i, 2)) - p)
                .norm());
    return nearest;
}

TEST(TriangleScene, NearestAgreesWithTryingEveryTriangle) {
    TestRandom random(1);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const TriangleMesh mesh = RandomMesh(seed, 40, 60);
        const TriangleScene scene(mesh);
        for (int i = 0; i < 100; ++i) {
            const Vector3d p = random.Point(i % 10 == 0 ? 100 : 1.5);
            EXPECT_EQ(scene.Nearest(p).distance_m, NearestByHand(mesh, p)) << p.transpose();
        }
    }
}

TEST(TriangleScene, NearestStopsAtTheLimit) {
    const TriangleScene scene(Square(2, 1, 0));
    EXPECT_DOUBLE_EQ(scene.Nearest({0.3, 0.2, 0.25}, 0.25).distance_m, 0.25);
    EXPECT_FALSE(scene.Nearest({0.3, 0.2, 0.2501}, 0.25).found());
    EXPECT_NEAR(scene.Nearest({0.3, 0.2, 0}, 0.25).distance_m, 0, 1e-15);
}

TEST(TriangleScene, NothingIsNearAnEmptyMesh) {
    const TriangleScene scene{TriangleMesh{}};
    EXPECT_FALSE(scene.Nearest(Vector3d::Zero()).found());
    EXPECT_FALSE(scene
                     .CastFour(Vector3f::Zero(),
                               {Vector3f(0, 0, 1), {1, 0, 0}, {0, 1, 0}, {1, 1, 1}}, false)[0]
                     .hit());
}

TEST(TriangleScene, RaysGiveTriangleDistanceAndBarycentrics) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 2}, {0, 1, 2}, {1, 0, 2}};
    mesh.triangles = {{0, 1, 2}};  // counter-clockwise when seen from the origin
    const TriangleScene scene(mesh);
    const auto hits = scene.CastFour(
        Vector3f::Zero(),
        {Vector3f(0.25f, 0.5f, 2), {0.05f, 0.05f, 1}, {0.6f, 0.6f, 2}, {0, 0, -1}}, true);
    ASSERT_TRUE(hits[0].hit() && hits[1].hit());
    EXPECT_FLOAT_EQ(hits[0].distance, 1);
    EXPECT_FLOAT_EQ(hits[0].u, 0.5f);
    EXPECT_FLOAT_EQ(hits[0].v, 0.25f);
    EXPECT_FLOAT_EQ(hits[1].distance, 2);
    EXPECT_FALSE(hits[2].hit());
    EXPECT_FALSE(hits[3].hit());
}

// Two triangles, of which the nearer one faces away. It is culled, and the ray continues to the
// second.
TEST(TriangleScene, RaysPassThroughBackFaces) {
    TriangleMesh mesh;
    mesh.vertices = {{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}, {-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};
    mesh.triangles = {{0, 1, 2}, {3, 5, 4}};  // normals +z (away from the ray) and -z
    const TriangleScene scene(mesh);
    const std::array<Vector3f, 4> ahead = {Vector3f(0, 0, 1), {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    for (const RayHit& hit : scene.CastFour(Vector3f::Zero(), ahead, true)) {
        EXPECT_EQ(hit.triangle, 1u);
        EXPECT_FLOAT_EQ(hit.distance, 2);
    }
    for (const RayHit& hit : scene.CastFour(Vector3f::Zero(), ahead, false))
        EXPECT_EQ(hit.triangle, 0u);
}

}  // namespace
}  // namespace tessera
