#include "plan/mesh_samples.h"

#include <gtest/gtest.h>

#include "box_world.h"

namespace tessera {
namespace {

// A unit square of n x n x 2 triangles.
TriangleMesh Square(std::uint32_t n) {
    TriangleMesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x)
            mesh.vertices.emplace_back(static_cast<float>(x) / static_cast<float>(n),
                                       static_cast<float>(y) / static_cast<float>(n), 0.F);
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x, b = a + n + 1;
            mesh.triangles.push_back({a, a + 1, b + 1});
            mesh.triangles.push_back({a, b + 1, b});
        }
    return mesh;
}

TEST(MeshSamples, AreAsManyHoweverTheSurfaceIsCut) {
    for (const std::uint32_t n : {1U, 7U, 300U}) {
        const Result<MeshSamples> samples = SampleMesh(Square(n));
        ASSERT_TRUE(samples.ok());
        EXPECT_NEAR(static_cast<double>(samples.value().surface.vertices.size()), 1e4, 2);
        std::vector<int> tenths(100);
        for (const Eigen::Vector3f& p : samples.value().surface.vertices)
            ++tenths[static_cast<std::size_t>(10 * p.x()) +
                     10 * static_cast<std::size_t>(10 * p.y())];
        for (const int count : tenths) EXPECT_NEAR(count, 100, 30) << n;
        for (const Eigen::Vector3f& normal : samples.value().surface.normals)
            EXPECT_NEAR(normal.z(), 1, 1e-5);
    }
}

TEST(MeshSamples, GrowApartOnALargeSurface) {
    TriangleMesh mesh = Square(1);
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= 400;
    const Result<MeshSamples> samples = SampleMesh(mesh);
    ASSERT_TRUE(samples.ok());
    EXPECT_LE(samples.value().surface.vertices.size(), 6'000'001U);
    EXPECT_NEAR(samples.value().spacing_m, 400 / std::sqrt(6e6), 1e-6);
}

}  // namespace
}  // namespace tessera
