#include "mapping/map_delta.h"

#include <gtest/gtest.h>

#include <cstring>

#include "mapping/integrator.h"
#include "mapping/map_copier.h"
#include "mapping/mesher.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using namespace testing_support;

// Fuses frames of a moving camera. Tell sends the changes since the last call to the copy.
struct MovingMap {
    BlockMap::Layers layers = BlockMap::Layers::kFieldOnly;
    PinholeCamera camera = SmallCamera();
    BlockMap map{{.voxel_size_m = 0.02, .truncation_m = 0.08}};
    BlockMap copy{map.config(), layers};
    Integrator integrator{{}, camera};
    std::vector<BlockChange> came_and_went = {};
    std::vector<BlockId> back =
        {};  // blocks that returned to the map; the copy needs their field too

    void Fuse(int i) {
        BoxRoom room;
        room.has_ball = true;
        const Eigen::Isometry3d T_world_camera = SmoothPath(20 * i);
        PreparedFrame prepared;
        PrepareFrame(room.Render(camera, T_world_camera), {}, prepared);
        Integrator::View view;
        view.T_world_camera = T_world_camera;
        integrator.Integrate(prepared, view, map);
        for (const BlockId id : integrator.added_blocks())
            came_and_went.push_back({id, false, map.coord(id)});
    }
    void Release(BlockId id) {
        came_and_went.push_back({id, true, map.coord(id)});
        map.Release(id);
    }
    void Return(const BlockCoord& coord, FieldWord word) {
        const BlockId id = map.Allocate(coord);
        std::fill_n(map.field(id), kBlockVoxels, word);
        map.MarkChanged(id, integrator.revision());
        came_and_went.push_back({id, false, coord});
        back.push_back(id);
    }
    void Tell() {
        MapDelta delta;
        std::vector<BlockId> changed = integrator.changed_blocks();
        changed.insert(changed.end(), back.begin(), back.end());
        CollectDelta(map, copy.layers(), came_and_went, changed, integrator.revision(), delta);
        came_and_went.clear();
        back.clear();
        ApplyDelta(delta, copy);
    }
};

TEST(MapDelta, TheCopyIsTheMapsFieldWordForWord) {
    MovingMap world;
    for (int i = 0; i < 8; ++i) {
        const BlockId before = world.map.size();
        world.Fuse(i);
        ASSERT_GT(world.map.size(), before);
        world.Tell();
        ASSERT_EQ(world.copy.size(), world.map.size());
        for (BlockId id = 0; id < world.map.size(); ++id) {
            ASSERT_EQ(world.copy.coord(id), world.map.coord(id));
            ASSERT_EQ(std::memcmp(world.copy.field(id), world.map.field(id),
                                  kBlockVoxels * sizeof(FieldWord)),
                      0)
                << "block " << id << " after frame " << i;
            ASSERT_EQ(world.copy.Find(world.map.coord(id)), id);
        }
    }
    EXPECT_LT(world.copy.bytes(), 0.6 * static_cast<double>(world.map.bytes()));
}

TEST(MapDelta, ACopyWithColoursHasThoseToo) {
    MovingMap world{BlockMap::Layers::kFieldAndColour};
    for (int i = 0; i < 4; ++i) {
        world.Fuse(i);
        world.Tell();
        for (BlockId id = 0; id < world.map.size(); ++id)
            ASSERT_EQ(std::memcmp(world.copy.colour(id), world.map.colour(id),
                                  kBlockVoxels * sizeof(ColourWord)),
                      0)
                << "block " << id << " after frame " << i;
    }
}

TEST(MapDelta, ACopyFollowsBlocksThatGoAndComeBack) {
    MovingMap world;
    for (int i = 0; i < 6; ++i) {
        world.Fuse(i);
        world.Tell();
        std::vector<BlockCoord> away;
        for (BlockId id = 1 + i; id < world.map.size(); id += 3) {
            if (world.map.IsFree(id)) continue;
            away.push_back(world.map.coord(id));
            world.Release(id);
        }
        for (std::size_t j = 0; j < away.size(); j += 4)
            world.Return(away[away.size() - 1 - j], 11u + static_cast<FieldWord>(j));
        world.Release(world.map.Find(away[away.size() - 1]));
        ASSERT_LT(world.map.count(), world.map.size() - 1);
    }
    world.Fuse(6);
    world.Tell();
    ASSERT_EQ(world.copy.size(), world.map.size());
    ASSERT_EQ(world.copy.count(), world.map.count());
    for (BlockId id = 0; id < world.map.size(); ++id) {
        ASSERT_EQ(world.copy.IsFree(id), world.map.IsFree(id));
        ASSERT_EQ(world.copy.coord(id), world.map.coord(id));
        ASSERT_EQ(std::memcmp(world.copy.field(id), world.map.field(id),
                              kBlockVoxels * sizeof(FieldWord)),
                  0)
            << id;
    }
}

TEST(CopyLayers, AreTheWholeLayersUnderTheSameIdsAndNewToWhoeverLooks) {
    MovingMap world;
    for (int i = 0; i < 3; ++i) world.Fuse(i);
    const std::unique_ptr<BlockMap> copy = CopyLayers(world.map, BlockMap::Layers::kFieldAndColour);
    ASSERT_EQ(copy->size(), world.map.size());
    for (BlockId id = 1; id < world.map.size(); ++id) {
        ASSERT_EQ(copy->coord(id), world.map.coord(id));
        ASSERT_EQ(copy->Find(world.map.coord(id)), id);
        ASSERT_EQ(
            std::memcmp(copy->field(id), world.map.field(id), kBlockVoxels * sizeof(FieldWord)), 0)
            << id;
        ASSERT_EQ(
            std::memcmp(copy->colour(id), world.map.colour(id), kBlockVoxels * sizeof(ColourWord)),
            0)
            << id;
        ASSERT_NE(copy->revision(id), 0u);
    }
    // The next delta continues from this copy.
    world.came_and_went.clear();
    world.Fuse(3);
    MapDelta delta;
    CollectDelta(world.map, BlockMap::Layers::kFieldAndColour, world.came_and_went,
                 world.integrator.changed_blocks(), world.integrator.revision(), delta);
    ApplyDelta(delta, *copy);
    for (BlockId id = 1; id < world.map.size(); ++id)
        ASSERT_EQ(
            std::memcmp(copy->field(id), world.map.field(id), kBlockVoxels * sizeof(FieldWord)), 0)
            << id;
}

// Blocks are found by their place.
void ExpectSameVoxels(const BlockMap& copy, const BlockMap& map) {
    for (BlockId id = 1; id < map.size(); ++id) {
        const BlockId here = copy.Find(map.coord(id));
        ASSERT_NE(here, kUnknownBlock);
        const auto same = [&](const auto* a, const auto* b) {
            return std::memcmp(a, b, kBlockVoxels * sizeof(*a)) == 0;
        };
        ASSERT_TRUE(same(copy.field(here), map.field(id))) << id;
        ASSERT_TRUE(same(copy.weight(here), map.weight(id))) << id;
        ASSERT_TRUE(same(copy.colour(here), map.colour(id))) << id;
    }
}

// While the map grows and changes beneath it.
TEST(MapCopier, TheCopyIsTheMapAsItIsAtTheEnd) {
    MovingMap world;
    MapCopier copier;
    for (int i = 0; i < 3; ++i) world.Fuse(i);
    constexpr int kSteps = 4;
    const int some = world.map.size() / kSteps;
    std::unique_ptr<BlockMap> copy;
    int steps = 0;
    for (; !copy; ++steps) {
        ASSERT_EQ(copier.begun(), steps > 0);
        copy = copier.Copy(world.map, world.integrator.revision(), some);
        if (!copy && steps < kSteps) world.Fuse(3 + steps);
    }
    EXPECT_GT(steps, kSteps);
    EXPECT_FALSE(copier.begun());
    ASSERT_EQ(copy->count(), world.map.count());
    ExpectSameVoxels(*copy, world.map);
}

TEST(MapCopier, BeginsAgainWithAnotherMap) {
    MovingMap world;
    MapCopier copier;
    const auto copy = [&](int blocks) {
        return copier.Copy(world.map, world.integrator.revision(), blocks);
    };
    world.Fuse(0);
    EXPECT_EQ(copy(10), nullptr);
    world.map.Clear();
    world.Fuse(1);
    const auto whole = copy(world.map.size());
    ASSERT_NE(whole, nullptr);
    EXPECT_EQ(whole->count(), world.map.count());
    EXPECT_EQ(copier.copied(world.map), world.integrator.revision());
    world.map.Clear();
    EXPECT_EQ(copier.copied(world.map), 0u);
}

// The map that is made of that copy may still be on its way.
TEST(MapCopier, KeepsTheRevisionOfTheLastWholeCopyWhileItMakesAnother) {
    MovingMap world;
    MapCopier copier;
    world.Fuse(0);
    const std::uint32_t revision = world.integrator.revision();
    ASSERT_NE(copier.Copy(world.map, revision, world.map.size()), nullptr);
    world.Fuse(1);
    ASSERT_EQ(copier.Copy(world.map, world.integrator.revision(), 1), nullptr);
    EXPECT_EQ(copier.copied(world.map), revision);
}

// A consumer that uses revisions to keep data derived from the copy up to date sees every change.
TEST(MapDelta, AMeshOfTheCopyFollowsIt) {
    MovingMap world;
    Mesher of_map({}), of_copy({});
    for (int i = 0; i < 4; ++i) {
        world.Fuse(i);
        world.Tell();
        of_map.Update(world.map);
        of_copy.Update(world.copy);
    }
    const TriangleMesh expected = of_map.Assemble(), actual = of_copy.Assemble();
    ASSERT_GT(expected.triangles.size(), 1000u);
    EXPECT_EQ(actual.triangles, expected.triangles);
    EXPECT_EQ(actual.vertices, expected.vertices);
    for (const Rgb8& c : actual.colours)  // the copy has intensity but no chroma
        ASSERT_TRUE(c.r == c.g && c.g == c.b) << int{c.r} << " " << int{c.g} << " " << int{c.b};
}

}  // namespace
}  // namespace tessera
