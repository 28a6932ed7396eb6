#include "mapping/block_mesh.h"

#include <gtest/gtest.h>

#include "mapping/analytic_fields.h"
#include "mapping/mesh_measures.h"

namespace tessera {
namespace {

using namespace testing_support;

TEST(BlockMesh, SphereIsWatertightWithRightAreaAndVolume) {
    const double r = 0.3;
    // Around the origin, so that blocks of every sign take part. One centre is off the voxel grid,
    // one is on it.
    for (const Eigen::Vector3d& centre :
         {Eigen::Vector3d(.0031, -.0042, .0013), Eigen::Vector3d(0, 0, 0)}) {
        const TriangleMesh mesh = MeshOf(Sphere(centre, r), {-6, -6, -6}, {5, 5, 5});
        EXPECT_EQ(BadEdges(mesh), 0);
        EXPECT_EQ(EulerCharacteristic(mesh), 2);
        EXPECT_NEAR(Area(mesh), 4 * M_PI * r * r, 0.01 * 4 * M_PI * r * r);
        EXPECT_NEAR(Volume(mesh), 4.0 / 3 * M_PI * r * r * r, 0.01 * 4.0 / 3 * M_PI * r * r * r);
        EXPECT_EQ(DistinctPositions(mesh), mesh.vertices.size());
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            const Eigen::Vector3d p = mesh.vertices[i].cast<double>() - centre;
            EXPECT_NEAR(p.norm(), r, 1e-4);
            EXPECT_GT(mesh.normals[i].cast<double>().dot(p.normalized()), 0.999);
        }
    }
}

TEST(BlockMesh, TopologyOfTorusAndTwoSpheres) {
    const TriangleMesh torus = MeshOf(Torus({.002, .001, .003}, .3, .1), {-6, -6, -6}, {5, 5, 5});
    EXPECT_EQ(BadEdges(torus), 0);
    EXPECT_EQ(EulerCharacteristic(torus), 0);
    EXPECT_NEAR(Area(torus), 4 * M_PI * M_PI * .3 * .1, 0.01 * 4 * M_PI * M_PI * .3 * .1);
    const TriangleMesh two = MeshOf(Union(Sphere({-.25, 0, 0}, .15), Sphere({.25, .01, 0}, .15)),
                                    {-6, -6, -6}, {5, 5, 5});
    EXPECT_EQ(BadEdges(two), 0);
    EXPECT_EQ(EulerCharacteristic(two), 4);
}

// The faces of the box pass exactly through voxels, so their distances are exactly zero.
TEST(BlockMesh, SurfaceThroughVoxelsHasNoDegenerateTriangles) {
    const TriangleMesh mesh = MeshOf(Box({0, 0, 0}, {.2, .16, .1}), {-5, -5, -5}, {4, 4, 4});
    EXPECT_EQ(BadEdges(mesh), 0);
    EXPECT_EQ(EulerCharacteristic(mesh), 2);
    EXPECT_EQ(DistinctPositions(mesh), mesh.vertices.size());
    for (const auto& t : mesh.triangles) EXPECT_GT(TriangleCross(mesh, t).norm(), 0);
    EXPECT_NEAR(Volume(mesh), .4 * .32 * .2, 0.01 * .4 * .32 * .2);
}

// Independent noise at every voxel gives all 256 configurations and all ambiguous faces. Every edge
// inside the known region is used exactly once in each direction. Edges that are used once lie on
// the boundary of the region.
TEST(BlockMesh, NoiseHasNoCracks) {
    BlockMap map{BlockMap::Config{}};
    std::uint32_t counter = 0;
    const Sdf noise = [&](const Eigen::Vector3d&) {
        return 0.9 * .04 * (2 * Uniform(++counter) - 1);
    };
    for (int z = -2; z <= 1; ++z)
        for (int y = -2; y <= 1; ++y)
            for (int x = -2; x <= 1; ++x)
                FillBlock(map, map.Allocate({x, y, z}), noise, nullptr, 1);
    const TriangleMesh mesh = MeshOf(map);
    EXPECT_GT(mesh.triangles.size(), 60000u);
    const float low = -.16f, high = .15f;
    const auto on_boundary = [&](std::uint32_t a, std::uint32_t b) {
        for (int i = 0; i < 3; ++i)
            for (const float side : {low, high})
                if (std::abs(mesh.vertices[a][i] - side) < 1e-6f &&
                    std::abs(mesh.vertices[b][i] - side) < 1e-6f)
                    return true;
        return false;
    };
    EXPECT_EQ(BadEdges(mesh, on_boundary), 0);
    EXPECT_EQ(DistinctPositions(mesh), mesh.vertices.size());
}

TEST(BlockMesh, ColoursAreInterpolatedBetweenVoxels) {
    const Paint paint = [](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(.5 + p.x(), .4 - p.y(), .5 + .5 * p.z());
    };
    const TriangleMesh mesh =
        MeshOf(Sphere({.001, .002, .003}, .3), {-6, -6, -6}, {5, 5, 5}, paint);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Eigen::Vector3d expected = 255 * paint(mesh.vertices[i].cast<double>());
        EXPECT_NEAR(mesh.colours[i].r, expected.x(), 1.2);
        EXPECT_NEAR(mesh.colours[i].g, expected.y(), 1.2);
        EXPECT_NEAR(mesh.colours[i].b, expected.z(), 1.2);
    }
}

TEST(BlockMesh, ColourOfOneEndOrGrey) {
    BlockMap map{BlockMap::Config{}};
    const Sdf plane = Plane({0, 0, 1}, .0351);
    Fill(map, plane, {0, 0, 0}, {0, 0, 0});
    const BlockId id = map.Find({0, 0, 0});
    // Left half: only the voxels below the surface, at z = 3, have colour.
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 4; ++x) {
            const int offset = x + 8 * y + 64 * 3;
            map.field(id)[offset] |= PackField(0, .8) & 0xffffu;
            map.colour(id)[offset] = PackColour({.8, .8, .8});
        }
    const TriangleMesh mesh = MeshOf(map);
    ASSERT_EQ(mesh.vertices.size(), 64u);
    for (std::size_t i = 0; i < 64; ++i)
        EXPECT_EQ(mesh.colours[i].r, mesh.vertices[i].x() < .035f ? 204 : 128);
}

TEST(BlockMesh, OnlyCellsOfKnownAndWeightedVoxels) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane({0, 0, 1}, .0351), {0, 0, 0}, {0, 0, 0});
    const BlockId id = map.Find({0, 0, 0});
    EXPECT_EQ(MeshOf(map).triangles.size(), 2 * 49u);
    map.weight(id)[3 + 8 * 3 + 64 * 3] = static_cast<std::uint16_t>(.4f * kWeightSteps);
    Mesher::Config config;
    config.min_component_triangles = 0;
    config.min_weight = .5;
    Mesher mesher(config);
    mesher.Update(map);
    EXPECT_EQ(mesher.Assemble().triangles.size(), 2 * 45u);  // minus the four cells around it
    map.field(id)[3 + 8 * 3 + 64 * 3] = kUnknownField;
    EXPECT_EQ(MeshOf(map).triangles.size(), 2 * 45u);
}

// A jump over the whole range between neighbouring voxels is a depth discontinuity, not a surface.
TEST(BlockMesh, JumpsFromFrontToBehindAreNoSurface) {
    BlockMap map{BlockMap::Config{}};
    const Sdf step = [](const Eigen::Vector3d& p) { return p.x() < .035 ? 1.0 : -1.0; };
    Fill(map, [](const Eigen::Vector3d&) { return 0.0; }, {0, 0, 0}, {0, 0, 0});
    FillBlock(map, map.Find({0, 0, 0}), step, nullptr, 2);
    EXPECT_EQ(MeshOf(map).triangles.size(), 0u);
    const Sdf steep = [&](const Eigen::Vector3d& p) { return .035 * step(p); };
    FillBlock(map, map.Find({0, 0, 0}), steep, nullptr, 3);
    EXPECT_EQ(MeshOf(map).triangles.size(), 2 * 49u);
}

}  // namespace
}  // namespace tessera
