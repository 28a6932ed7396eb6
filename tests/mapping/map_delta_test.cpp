#include "mapping/map_delta.h"

#include <gtest/gtest.h>

#include <cstring>

#include "mapping/integrator.h"
#include "mapping/mesher.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using namespace testing_support;

// Fuses frames of a moving camera; after every second one the copy hears of what changed.
struct MovingMap {
    PinholeCamera camera = SmallCamera();
    BlockMap map{{.voxel_size_m = 0.02, .truncation_m = 0.08}};
    BlockMap copy{map.config(), BlockMap::Layers::kFieldOnly};
    Integrator integrator{{}, camera};
    BlockId told = 1;

    void Fuse(int i) {
        BoxRoom room;
        room.has_ball = true;
        const Eigen::Isometry3d T_world_camera = SmoothPath(20 * i);
        PreparedFrame prepared;
        PrepareFrame(room.Render(camera, T_world_camera), {}, prepared);
        Integrator::View view;
        view.T_world_camera = T_world_camera;
        integrator.Integrate(prepared, view, map);
    }
    void Tell() {
        MapDelta delta;
        CollectDelta(map, told, integrator.changed_blocks(), integrator.revision(), delta);
        told = map.size();
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
            ASSERT_EQ(std::memcmp(world.copy.field(id), world.map.field(id), kBlockVoxels * sizeof(FieldWord)), 0)
                << "block " << id << " after frame " << i;
            ASSERT_EQ(world.copy.Find(world.map.coord(id)), id);
        }
    }
    EXPECT_LT(world.copy.bytes(), 0.6 * static_cast<double>(world.map.bytes()));
}

TEST(CopyField, IsTheWholeFieldUnderTheSameIdsAndNewToWhoeverLooks) {
    MovingMap world;
    for (int i = 0; i < 3; ++i) world.Fuse(i);
    const std::unique_ptr<BlockMap> copy = CopyField(world.map);
    ASSERT_EQ(copy->size(), world.map.size());
    for (BlockId id = 1; id < world.map.size(); ++id) {
        ASSERT_EQ(copy->coord(id), world.map.coord(id));
        ASSERT_EQ(copy->Find(world.map.coord(id)), id);
        ASSERT_EQ(std::memcmp(copy->field(id), world.map.field(id), kBlockVoxels * sizeof(FieldWord)), 0) << id;
        ASSERT_NE(copy->revision(id), 0u);
    }
    // The next delta goes on from there.
    const BlockId told = world.map.size();
    world.Fuse(3);
    MapDelta delta;
    CollectDelta(world.map, told, world.integrator.changed_blocks(), world.integrator.revision(), delta);
    ApplyDelta(delta, *copy);
    for (BlockId id = 1; id < world.map.size(); ++id)
        ASSERT_EQ(std::memcmp(copy->field(id), world.map.field(id), kBlockVoxels * sizeof(FieldWord)), 0) << id;
}

// Whoever keeps what it made from the copy up to date by revisions sees every change.
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
    for (const Rgb8& c : actual.colours)  // its intensity without its chroma
        ASSERT_TRUE(c.r == c.g && c.g == c.b) << int{c.r} << " " << int{c.g} << " " << int{c.b};
}

}  // namespace
}  // namespace tessera
