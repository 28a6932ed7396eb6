// Blocks that move rigidly, and those about which shifts disagree.
#include "optimize/block_mover.h"

#include <gtest/gtest.h>

#include "core/se3.h"
#include "optimize/map_rebuild.h"

namespace tessera {
namespace {

const BlockMap::Config kMoved{.voxel_size_m = 0.04, .truncation_m = 0.16};

FieldWord Word(double distance_m) {
    const auto steps = static_cast<std::int32_t>(
        std::lround(distance_m / kMoved.truncation_m * static_cast<double>(kDistanceSteps)));
    return static_cast<FieldWord>(steps) << 16;
}

BlockId Add(BlockMap& map, const BlockCoord& c, double distance_m) {
    const BlockId id = map.Allocate(c);
    std::fill_n(map.field(id), kBlockVoxels, Word(distance_m));
    return id;
}

Eigen::Vector3d PlaceOfVoxel(const BlockCoord& c, int in) {
    return kMoved.voxel_size_m *
           Eigen::Vector3d(8 * c.x + (in & 7), 8 * c.y + (in >> 3 & 7), 8 * c.z + (in >> 6));
}

// A wall, whose distances are linear, turned by more than a block at its ends.
TEST(MoveRigidly, TurnsAWall) {
    const Eigen::Vector3d normal(0, 0, 1);
    BlockMap map(kMoved);
    std::vector<BlockId> all;
    for (int i = 0; i < 9 * 9 * 2; ++i) {
        const BlockCoord c{i % 9 - 4, i / 9 % 9 - 4, i / 81 - 1};
        all.push_back(Add(map, c, 0));
        for (int in = 0; in < kBlockVoxels; ++in)
            map.field(all.back())[in] = Word(0.5 * PlaceOfVoxel(c, in).dot(normal));
    }
    const Eigen::Isometry3d T = Se3Exp((Vector6d() << 0.3, -0.1, 0.2, 0.5, 0.1, -0.3).finished());
    BlockMap moved(kMoved);
    BlockMover mover = MoveRigidly(map, all, T, {});
    while (!mover.Step(moved)) continue;
    EXPECT_EQ(static_cast<std::int64_t>(mover.added().size()), moved.count());
    int known = 0;
    for (BlockId id = 1; id < moved.size(); ++id)
        for (int in = 0; in < kBlockVoxels; ++in) {
            const FieldWord word = moved.field(id)[in];
            if (!HasDistance(word)) continue;
            const Eigen::Vector3d from = T.inverse() * PlaceOfVoxel(moved.coord(id), in);
            // At the edge of what is known, the mean of fewer voxels is not linear.
            if (from.cwiseAbs().head<2>().maxCoeff() > 1.1 || std::abs(from.z()) > 0.2) continue;
            ++known;
            EXPECT_NEAR(FieldDistance(word) * kMoved.truncation_m, 0.5 * from.z(), 1e-4);
        }
    EXPECT_GT(known, 20000);
}

// Free space is not added, but takes away the surface that was there.
TEST(BlockMover, FreeSpaceReplacesSurface) {
    BlockMap map(kMoved), to(kMoved);
    const std::vector<BlockId> free{Add(map, {0, 0, 0}, kMoved.truncation_m),
                                    Add(map, {4, 0, 0}, kMoved.truncation_m)};
    const BlockId there = Add(to, {0, 0, 0}, 0);
    BlockMover mover = MoveRigidly(map, free, Eigen::Isometry3d::Identity(), {});
    while (!mover.Step(to)) continue;
    EXPECT_EQ(to.count(), 1);
    EXPECT_EQ(to.field(there)[0], Word(kMoved.truncation_m));
}

// In blocks that changed after the given revision only unknown voxels are filled in.
TEST(BlockMover, KeepsWhatIsNewer) {
    BlockMap map(kMoved), to(kMoved);
    const std::vector<BlockId> all{Add(map, {0, 0, 0}, 0.04), Add(map, {4, 0, 0}, 0.04)};
    const BlockId newer = Add(to, {0, 0, 0}, 0.08), older = Add(to, {4, 0, 0}, 0.08);
    to.field(newer)[7] = kUnknownField;
    to.MarkChanged(newer, 6);
    to.MarkChanged(older, 5);
    BlockMover mover = MoveRigidly(map, all, Eigen::Isometry3d::Identity(), {});
    while (!mover.Step(to, 5)) continue;
    EXPECT_EQ(to.field(newer)[0], Word(0.08));
    EXPECT_EQ(to.field(newer)[7], Word(0.04));
    EXPECT_EQ(to.field(older)[0], Word(0.04));
    EXPECT_TRUE(mover.added().empty());
}

// Labels that came after the copy was made belong to objects that the new map does not have.
TEST(MoveRigidly, LeavesLabels) {
    BlockMap map(kMoved), to(kMoved);
    map.EnableLabels();
    to.EnableLabels();
    const std::vector<BlockId> all{Add(map, {0, 0, 0}, 0.04)};
    map.label(all[0])[0].instance = 7;
    BlockMover mover = MoveRigidly(map, all, Eigen::Isometry3d::Identity(), {});
    while (!mover.Step(to)) continue;
    ASSERT_EQ(to.count(), 1);
    EXPECT_EQ(to.label(to.Find({0, 0, 0}))[0].instance, VoxelLabel{}.instance);
}

// Two walls come to lie on each other, and one block of a third is seen at two places.
TEST(MapWarp, MovesDoubtfulBlocksAsTheOldestPart) {
    BlockMap map(kMoved);
    std::vector<BlockMotion> motions(1);
    const auto add = [&](const BlockCoord& c, double distance_m, float shift_m, float spread_m) {
        Add(map, c, distance_m);
        motions.push_back({{shift_m, 0, 0}, spread_m, true});
    };
    add({0, 0, 0}, 0.04, 0.32f, 0);
    add({3, 0, 0}, 0.08, -0.64f, 0);  // onto the first
    add({10, 0, 0}, 0.12, 0.32f, 1);
    MapWarp warp(map, motions, {}, 0.04, MapWarp::Doubtful::kMoved);
    while (!warp.Step()) continue;
    const WarpedMap warped = warp.Take();
    EXPECT_TRUE(warped.whole);
    EXPECT_EQ(warped.doubtful, (std::vector<BlockCoord>{{1, 0, 0}, {11, 0, 0}}));
    EXPECT_EQ(warped.map->count(), 2);
    const auto word = [&](const BlockCoord& c) {
        return warped.map->field(warped.map->Find(c))[9];
    };
    EXPECT_EQ(word({1, 0, 0}), Word(0.04));
    EXPECT_EQ(word({11, 0, 0}), Word(0.12));
}

// A busy live run does not store all frames.
TEST(MapRebuild, KeepsDoubtfulBlocksThatNoStoredFrameSaw) {
    BlockMap map(kMoved);
    Add(map, {0, 0, 0}, 0.04);
    MapWarp warp(map, {{}, {{0.32f, 0, 0}, 1, true}}, {}, 0.04);
    FieldSettings settings;
    settings.map = kMoved;
    MapRebuild rebuild(settings, {Eigen::Isometry3d::Identity()}, std::move(warp));
    FrameStore none(1000000, 5000);
    while (!rebuild.Step(none, 1).value()) continue;
    const std::unique_ptr<BlockMap> whole = rebuild.TakeMap();
    EXPECT_EQ(whole->count(), 1);
    EXPECT_EQ(whole->field(whole->Find({1, 0, 0}))[9], Word(0.04));
}

}  // namespace
}  // namespace tessera
