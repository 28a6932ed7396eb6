#include "mapping/mesher.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapping/analytic_fields.h"
#include "mapping/mesh_measures.h"

namespace tessera {
namespace {

using namespace testing;

// 1 cm voxels, 4 cm truncation.
TriangleMesh MeshOf(const BlockMap& map, int min_component_triangles = 0) {
    Mesher::Config config;
    config.min_component_triangles = min_component_triangles;
    Mesher mesher(config);
    EXPECT_EQ(mesher.Update(map), 0);
    return mesher.Assemble();
}

TriangleMesh MeshOf(const Sdf& sdf, const BlockCoord& low, const BlockCoord& high,
                    const Paint& paint = nullptr) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, sdf, low, high, paint);
    return MeshOf(map);
}

TEST(Mesher, SphereIsWatertightWithRightAreaAndVolume) {
    const double r = 0.3;
    // Around the origin, so that blocks of every sign take part; off the voxels' raster and on it.
    for (const Eigen::Vector3d& centre : {Eigen::Vector3d(.0031, -.0042, .0013), Eigen::Vector3d(0, 0, 0)}) {
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

TEST(Mesher, TopologyOfTorusAndTwoSpheres) {
    const TriangleMesh torus = MeshOf(Torus({.002, .001, .003}, .3, .1), {-6, -6, -6}, {5, 5, 5});
    EXPECT_EQ(BadEdges(torus), 0);
    EXPECT_EQ(EulerCharacteristic(torus), 0);
    EXPECT_NEAR(Area(torus), 4 * M_PI * M_PI * .3 * .1, 0.01 * 4 * M_PI * M_PI * .3 * .1);
    const TriangleMesh two = MeshOf(Union(Sphere({-.25, 0, 0}, .15), Sphere({.25, .01, 0}, .15)),
                                    {-6, -6, -6}, {5, 5, 5});
    EXPECT_EQ(BadEdges(two), 0);
    EXPECT_EQ(EulerCharacteristic(two), 4);
}

// The box's faces go exactly through voxels: distances of exactly zero.
TEST(Mesher, SurfaceThroughVoxelsHasNoDegenerateTriangles) {
    const TriangleMesh mesh = MeshOf(Box({0, 0, 0}, {.2, .16, .1}), {-5, -5, -5}, {4, 4, 4});
    EXPECT_EQ(BadEdges(mesh), 0);
    EXPECT_EQ(EulerCharacteristic(mesh), 2);
    EXPECT_EQ(DistinctPositions(mesh), mesh.vertices.size());
    for (const auto& t : mesh.triangles) EXPECT_GT(TriangleCross(mesh, t).norm(), 0);
    EXPECT_NEAR(Volume(mesh), .4 * .32 * .2, 0.01 * .4 * .32 * .2);
}

// Independent noise at every voxel: all 256 configurations, all ambiguous faces. Inside the known region every edge is
// used exactly twice; what is used once lies in the region's boundary.
TEST(Mesher, NoiseHasNoCracks) {
    BlockMap map{BlockMap::Config{}};
    std::uint32_t counter = 0;
    const Sdf noise = [&](const Eigen::Vector3d&) { return 0.9 * .04 * (2 * Uniform(++counter) - 1); };
    for (int z = -2; z <= 1; ++z)
        for (int y = -2; y <= 1; ++y)
            for (int x = -2; x <= 1; ++x) FillBlock(map, map.Allocate({x, y, z}), noise, nullptr, 1);
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

TEST(Mesher, ColoursAreInterpolatedBetweenVoxels) {
    const Paint paint = [](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(.5 + p.x(), .4 - p.y(), .5 + .5 * p.z());
    };
    const TriangleMesh mesh = MeshOf(Sphere({.001, .002, .003}, .3), {-6, -6, -6}, {5, 5, 5}, paint);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Eigen::Vector3d expected = 255 * paint(mesh.vertices[i].cast<double>());
        EXPECT_NEAR(mesh.colours[i].r, expected.x(), 1.2);
        EXPECT_NEAR(mesh.colours[i].g, expected.y(), 1.2);
        EXPECT_NEAR(mesh.colours[i].b, expected.z(), 1.2);
    }
}

TEST(Mesher, ColourOfOneEndOrGrey) {
    BlockMap map{BlockMap::Config{}};
    const Sdf plane = Plane({0, 0, 1}, .0351);
    Fill(map, plane, {0, 0, 0}, {0, 0, 0});
    const BlockId id = map.Find({0, 0, 0});
    // Left half: colour below the surface only, at z = 3.
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

TEST(Mesher, OnlyCellsOfKnownAndWeightedVoxels) {
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
    EXPECT_EQ(mesher.Assemble().triangles.size(), 2 * 45u);  // without the four cells around it
    map.field(id)[3 + 8 * 3 + 64 * 3] = kUnknownField;
    EXPECT_EQ(MeshOf(map).triangles.size(), 2 * 45u);
}

// Where the field jumps over its whole range between neighbours there is an occlusion's edge, not a surface.
TEST(Mesher, JumpsFromFrontToBehindAreNoSurface) {
    BlockMap map{BlockMap::Config{}};
    const Sdf step = [](const Eigen::Vector3d& p) { return p.x() < .035 ? 1.0 : -1.0; };
    Fill(map, [](const Eigen::Vector3d&) { return 0.0; }, {0, 0, 0}, {0, 0, 0});
    FillBlock(map, map.Find({0, 0, 0}), step, nullptr, 2);
    EXPECT_EQ(MeshOf(map).triangles.size(), 0u);
    const Sdf steep = [&](const Eigen::Vector3d& p) { return .035 * step(p); };
    FillBlock(map, map.Find({0, 0, 0}), steep, nullptr, 3);
    EXPECT_EQ(MeshOf(map).triangles.size(), 2 * 49u);
}

TEST(Mesher, SmallComponentsAreLeftOut) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Union(Sphere({0, 0, 0}, .2), Sphere({.3, .001, .002}, .02)), {-5, -5, -5}, {6, 5, 5});
    EXPECT_EQ(EulerCharacteristic(MeshOf(map)), 4);
    const TriangleMesh filtered = MeshOf(map, 200);
    EXPECT_EQ(EulerCharacteristic(filtered), 2);
    for (const auto& v : filtered.vertices) EXPECT_LT(v.norm(), .21f);
    EXPECT_EQ(filtered.normals.size(), filtered.vertices.size());
}

// A block's change concerns the 17 blocks whose mesh reads it, no more.
TEST(Mesher, ChangeReachesTheReadersOnly) {
    BlockMap map{BlockMap::Config{}};
    for (int z = -2; z <= 2; ++z)
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x)
                FillBlock(map, map.Allocate({x, y, z}), Sphere({0, 0, 0}, .1), nullptr, 1);
    Mesher mesher{Mesher::Config{}};
    EXPECT_EQ(mesher.Update(map, 0), 125);
    EXPECT_EQ(mesher.Update(map), 0);
    EXPECT_EQ(mesher.Update(map, 0), 0);
    map.MarkChanged(map.Find({0, 0, 0}), 2);
    EXPECT_EQ(mesher.Update(map, 0), kMeshReads);
}

// Random edits of single voxels, whole blocks and new blocks: whatever changed where, the incremental mesh has the
// bytes of one made from scratch.
TEST(Mesher, IncrementalEqualsFromScratch) {
    BlockMap map{BlockMap::Config{}};
    Mesher::Config config;
    config.min_component_triangles = 0;
    config.min_weight = .5;
    Mesher incremental(config);
    std::uint32_t counter = 12345;
    const auto uniform = [&] { return Uniform(++counter); };
    const auto random = [&](int n) { return static_cast<int>(Mix(++counter) % static_cast<unsigned>(n)); };
    const Paint paint = [&](const Eigen::Vector3d&) {
        return Eigen::Vector3d(Eigen::Vector3d::NullaryExpr([&](auto) { return uniform(); }));
    };
    for (std::uint32_t revision = 1; revision <= 300; ++revision) {
        const BlockId id = map.Allocate({random(3) - 2, random(3) - 2, random(3) - 2});
        if (revision <= 27 || random(4) == 0) {
            const double z = .1 * uniform();
            FillBlock(map, id, Plane(Eigen::Vector3d(1, 2, 3).normalized(), z), paint, revision);
        }
        for (int edit = 0; edit < 8; ++edit) {
            const int corner = 7 * random(2) + 56 * random(2) + 448 * random(2);
            const int offset = random(2) ? corner : random(kBlockVoxels);
            const double distance = 2 * uniform() - 1;
            map.field(id)[offset] = random(6) ? PackField(distance, uniform()) : kUnknownField;
            map.weight(id)[offset] = static_cast<std::uint16_t>(random(8) ? 256 : 100);
            map.colour(id)[offset] = PackColour(paint({}));
        }
        map.MarkChanged(id, revision);
        if (random(3) == 0) continue;  // several changes at once
        incremental.Update(map);
        Mesher scratch(config);
        scratch.Update(map);
        ASSERT_TRUE(SameBytes(incremental.Assemble(), scratch.Assemble())) << "revision " << revision;
    }
    EXPECT_GT(incremental.Assemble().triangles.size(), 500u);
}

TEST(Mesher, BudgetSpreadsTheWorkAndEndsAtTheSameMesh) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Sphere({0, 0, 0}, .3), {-6, -6, -6}, {5, 5, 5});
    Mesher::Config config;
    Mesher mesher(config);
    const int all = mesher.Update(map, 0);
    EXPECT_EQ(all, map.size() - 1);
    for (int remaining = all; remaining > 0;) {
        const int before = remaining;
        remaining = mesher.Update(map, 50);
        EXPECT_EQ(remaining, std::max(before - 50, 0));
        const TriangleMesh part = mesher.Assemble();
        for (const auto& t : part.triangles)
            for (const std::uint32_t v : t) ASSERT_LT(v, part.vertices.size());
    }
    EXPECT_TRUE(SameBytes(mesher.Assemble(), MeshOf(map, config.min_component_triangles)));
}

// A neighbour meshed at another time may lack a vertex: the triangle is left out, nothing else.
TEST(Mesher, StaleNeighboursMakeGapsNotGarbage) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane({0, 0, 1}, .0351), {0, 0, 0}, {1, 0, 0});
    Mesher::Config config;
    config.min_component_triangles = 0;
    Mesher mesher(config);
    mesher.Update(map);
    EXPECT_EQ(mesher.Assemble().triangles.size(), 2u * 15 * 7);
    FillBlock(map, map.Find({1, 0, 0}), Plane({0, 0, 1}, .0551), nullptr, 2);
    EXPECT_EQ(mesher.Update(map, 1), 1);
    const std::size_t gap = mesher.Assemble().triangles.size();
    EXPECT_EQ(mesher.Update(map), 0);
    EXPECT_LT(gap, mesher.Assemble().triangles.size());
    EXPECT_GE(gap, 2u * 14 * 7);
}

TEST(Mesher, SameBytesForAnyNumberOfThreads) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Torus({.002, .001, .003}, .3, .1), {-6, -6, -6}, {5, 5, 5});
    const auto with_threads = [&](std::size_t n) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
        return MeshOf(map, 30);
    };
    const TriangleMesh one = with_threads(1);
    EXPECT_TRUE(SameBytes(one, with_threads(4)));
    EXPECT_TRUE(SameBytes(one, with_threads(2)));
}

TEST(Mesher, ClearStartsAgainAndEmptyMapIsEmptyMesh) {
    BlockMap map{BlockMap::Config{}};
    Mesher mesher{Mesher::Config{}};
    EXPECT_EQ(mesher.Update(map), 0);
    EXPECT_TRUE(mesher.Assemble().vertices.empty());
    Fill(map, Sphere({0, 0, 0}, .2), {-4, -4, -4}, {3, 3, 3});
    mesher.Update(map);
    EXPECT_FALSE(mesher.Assemble().vertices.empty());
    map.Clear();
    mesher.Clear();
    EXPECT_EQ(mesher.Update(map), 0);
    EXPECT_TRUE(mesher.Assemble().triangles.empty());
}

}  // namespace
}  // namespace tessera
