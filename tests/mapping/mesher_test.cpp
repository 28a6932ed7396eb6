#include "mapping/mesher.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapping/analytic_fields.h"
#include "mapping/mesh_measures.h"

namespace tessera {
namespace {

using namespace testing_support;

TEST(Mesher, SmallComponentsAreLeftOut) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Union(Sphere({0, 0, 0}, .2), Sphere({.3, .001, .002}, .02)), {-5, -5, -5}, {6, 5, 5});
    EXPECT_EQ(EulerCharacteristic(MeshOf(map)), 4);
    const TriangleMesh filtered = MeshOf(map, 200);
    EXPECT_EQ(EulerCharacteristic(filtered), 2);
    for (const auto& v : filtered.vertices) EXPECT_LT(v.norm(), .21f);
    EXPECT_EQ(filtered.normals.size(), filtered.vertices.size());
}

// A change to a block affects only the 17 blocks whose mesh reads it.
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

// Random edits of single voxels and whole blocks, with blocks added and removed. The incremental
// mesh always has the same bytes as a mesh built from scratch.
TEST(Mesher, IncrementalEqualsFromScratch) {
    BlockMap map{BlockMap::Config{}};
    Mesher::Config config;
    config.min_component_triangles = 0;
    config.min_weight = .5;
    Mesher incremental(config);
    std::uint32_t counter = 12345;
    const auto uniform = [&] { return Uniform(++counter); };
    const auto random = [&](int n) {
        return static_cast<int>(Mix(++counter) % static_cast<unsigned>(n));
    };
    const Paint paint = [&](const Eigen::Vector3d&) {
        return Eigen::Vector3d(Eigen::Vector3d::NullaryExpr([&](auto) { return uniform(); }));
    };
    for (std::uint32_t revision = 1; revision <= 300; ++revision) {
        const BlockCoord coord{random(3) - 2, random(3) - 2, random(3) - 2};
        const bool is_new = map.Find(coord) == kUnknownBlock;
        const BlockId id = map.Allocate(coord);
        if (is_new || random(4) == 0) {
            const double z = .1 * uniform();
            FillBlock(map, id, Plane(Eigen::Vector3d(1, 2, 3).normalized(), z), paint, revision);
        }
        for (int edit = 8 * random(2); edit < 8; ++edit) {
            const int corner = 7 * random(2) + 56 * random(2) + 448 * random(2);
            const int offset = random(2) ? corner : random(kBlockVoxels);
            const double distance = 2 * uniform() - 1;
            map.field(id)[offset] = random(6) ? PackField(distance, uniform()) : kUnknownField;
            map.weight(id)[offset] = static_cast<std::uint16_t>(random(8) ? 256 : 100);
            map.colour(id)[offset] = PackColour(paint({}));
        }
        map.MarkChanged(id, revision);
        const BlockId gone = map.Find({random(3) - 2, random(3) - 2, random(3) - 2});
        if (revision > 100 && gone != kUnknownBlock && random(8) == 0) map.Release(gone);
        if (random(3) == 0) continue;  // accumulates several changes
        incremental.Update(map);
        Mesher scratch(config);
        scratch.Update(map);
        ASSERT_TRUE(SameBytes(incremental.Assemble(), scratch.Assemble()))
            << "revision " << revision;
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

// The surface lies between the last voxels of one block and the first voxels of the next. The cells
// of the next block contain no surface.
TEST(Mesher, ABlockWithoutSurfaceThatGoesTakesItsNeighboursSurfaceAlong) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane({1, 0, 0}, 7.5 * map.config().voxel_size_m), {0, 0, 0}, {1, 0, 0});
    Mesher::Config config;
    config.min_component_triangles = 0;
    Mesher mesher(config);
    mesher.Update(map);
    const BlockId other = map.Find({1, 0, 0});
    ASSERT_EQ(mesher.block_meshes()[static_cast<std::size_t>(other)], nullptr);
    EXPECT_EQ(mesher.Assemble().triangles.size(), 2u * 7 * 7);
    map.Release(other);
    mesher.Update(map);
    EXPECT_TRUE(mesher.Assemble().triangles.empty());
}

// A neighbour that was meshed at a different time may lack a vertex. Only that triangle is left
// out.
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
