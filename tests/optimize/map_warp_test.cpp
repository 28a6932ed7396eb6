// A map that follows its keyframes without being fused again.
#include "optimize/map_warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/se3.h"
#include "optimize/map_rebuild.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

const BlockMap::Config kWarped{.voxel_size_m = 0.04, .truncation_m = 0.16};

Frame WarpFrame(int i) {
    Frame frame = BoxRoom().Render(SmallCamera(), SmoothPath(i), i / 30.0);
    frame.index = i;
    return frame;
}

Eigen::Isometry3d WarpPose(int i) { return SmoothPath(0).inverse() * SmoothPath(i); }

void FuseFrames(BlockMap& map, int count) {
    Integrator integrator({}, SmallCamera());
    for (int i = 0; i < count; ++i) {
        PreparedFrame prepared;
        PrepareFrame(WarpFrame(i), {}, prepared);
        Integrator::View view;
        view.T_world_camera = WarpPose(i);
        integrator.Integrate(prepared, view, map);
    }
}

std::vector<BlockMotion> SameMotion(const BlockMap& map, const Eigen::Vector3f& shift_m) {
    return std::vector<BlockMotion>(static_cast<std::size_t>(map.size()), {shift_m, 0, true});
}

WarpedMap Warped(const BlockMap& map, const std::vector<BlockMotion>& motions,
                 const WorldBox& box = {}) {
    MapWarp warp(map, motions, box, 0.04);
    while (!warp.Step()) continue;
    return warp.Take();
}

struct VoxelPlace {
    BlockId id;
    int in;
};
VoxelPlace PlaceOf(const BlockMap& map, const Eigen::Vector3i& voxel) {
    return {map.Find({voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3}),
            (voxel.x() & 7) + 8 * (voxel.y() & 7) + 64 * (voxel.z() & 7)};
}

// Calls visit(voxel, id, index in the block) for each voxel that is known.
template <class Visit>
void ForEachKnown(const BlockMap& map, const Visit& visit) {
    for (BlockId id = 1; id < map.size(); ++id)
        for (int in = 0; in < kBlockVoxels; ++in) {
            const BlockCoord c = map.coord(id);
            const Eigen::Vector3i voxel(8 * c.x + (in & 7), 8 * c.y + (in >> 3 & 7),
                                        8 * c.z + (in >> 6));
            if (HasDistance(map.field(id)[in])) visit(voxel, id, in);
        }
}

TEST(MapWarp, CopiesVoxelsThatMoveByWholeOnes) {
    BlockMap map(kWarped);
    FuseFrames(map, 3);
    map.EnableLabels();
    for (BlockId id = 1; id < map.size(); ++id)
        for (int in = 0; in < kBlockVoxels; ++in)
            map.label(id)[in].instance = static_cast<InstanceId>(7 * id + in);
    const Eigen::Vector3i steps(3, -2, 9);
    const WarpedMap warped = Warped(map, SameMotion(map, steps.cast<float>() * 0.04f));
    EXPECT_TRUE(warped.doubtful.empty());
    int known = 0, found = 0, coloured = 0;
    ForEachKnown(map, [&](const Eigen::Vector3i& voxel, BlockId id, int in) {
        ++known;
        const VoxelPlace to = PlaceOf(*warped.map, voxel + steps);
        EXPECT_EQ(warped.map->field(to.id)[to.in], map.field(id)[in]);
        EXPECT_EQ(warped.map->weight(to.id)[to.in], map.weight(id)[in]);
        EXPECT_EQ(warped.map->label(to.id)[to.in].instance, map.label(id)[in].instance);
        if (!HasIntensity(map.field(id)[in])) return;
        EXPECT_EQ(warped.map->colour(to.id)[to.in], map.colour(id)[in]);
        ++coloured;
    });
    ForEachKnown(*warped.map, [&](const Eigen::Vector3i&, BlockId, int) { ++found; });
    EXPECT_EQ(found, known);
    EXPECT_GT(coloured, 1000);
}

// A wall that leans: d = a - n x. Distances are linear, and so is the motion, so both are
// interpolated exactly.
TEST(MapWarp, TurnsAWallToWhereItBelongs) {
    BlockMap map(kWarped);
    const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, 1).normalized();
    for (int i = 0; i < 5 * 5 * 3; ++i) {
        const BlockId id = map.Allocate({i % 5 - 2, i / 5 % 5 - 2, i / 25 - 1});
        for (int in = 0; in < kBlockVoxels; ++in) {
            const BlockCoord c = map.coord(id);
            const Eigen::Vector3d p =
                0.04 *
                Eigen::Vector3d(8 * c.x + (in & 7), 8 * c.y + (in >> 3 & 7), 8 * c.z + (in >> 6));
            const double d = -normal.dot(p);
            if (std::abs(d) > 0.15) continue;
            map.field(id)[in] = static_cast<FieldWord>(std::lround(d / 0.16 * kDistanceSteps))
                                << 16;
            map.weight(id)[in] = 512;
        }
    }
    const Eigen::Isometry3d T_new_old =
        Se3Exp((Vector6d() << 0.004, -0.006, 0.003, 0.05, -0.03, 0.027).finished());
    std::vector<BlockMotion> motions(static_cast<std::size_t>(map.size()));
    for (BlockId id = 1; id < map.size(); ++id) {
        const BlockCoord c = map.coord(id);
        const Eigen::Vector3d centre =
            0.04 * (8 * Eigen::Vector3d(c.x, c.y, c.z) + Eigen::Vector3d::Constant(3.5));
        motions[static_cast<std::size_t>(id)] = {(T_new_old * centre - centre).cast<float>(), 0,
                                                 true};
    }
    const WarpedMap warped = Warped(map, motions);
    EXPECT_TRUE(warped.doubtful.empty());
    const Eigen::Vector3d turned = T_new_old.linear() * normal;
    int inside = 0;
    double worst_m = 0;
    ForEachKnown(*warped.map, [&](const Eigen::Vector3i& voxel, BlockId id, int in) {
        const Eigen::Vector3d p = 0.04 * voxel.cast<double>();
        EXPECT_EQ(warped.map->weight(id)[in], 512);
        // At the ends of the slab, means are of fewer voxels.
        const double d = -turned.dot(p - T_new_old.translation());
        if (p.head<2>().cwiseAbs().maxCoeff() > 0.5 || std::abs(d) > 0.1) return;
        ++inside;
        worst_m = std::max(worst_m, std::abs(d - 0.16 * FieldDistance(warped.map->field(id)[in])));
    });
    EXPECT_GT(inside, 2000);
    EXPECT_LT(worst_m, 0.0005);  // not moved at all, it is 30 mm off
}

// Cubics reproduce a parabola, which the mean of neighbours misses by up to 5e-4.
TEST(MapWarp, DoesNotFlattenColours) {
    const auto intensity = [](float x) { return 0.3f + 0.002f * (x - 4) * (x - 4); };
    BlockMap map(kWarped);
    for (int i = 0; i < 27; ++i) {
        const BlockId id = map.Allocate({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
        for (int in = 0; in < kBlockVoxels; ++in) {
            const auto x = static_cast<float>(8 * (i % 3 - 1) + (in & 7));
            map.field(id)[in] =
                1u + static_cast<FieldWord>(std::lround(kIntensitySteps * intensity(x)));
            map.colour(id)[in] = 700u | 300u << 10 | 16u << 20;
        }
    }
    const WarpedMap warped = Warped(map, SameMotion(map, {0.016f, 0, 0}));
    const BlockId id = warped.map->Find({0, 0, 0});
    for (int in = 0; in < kBlockVoxels; ++in) {
        EXPECT_NEAR(FieldIntensity(warped.map->field(id)[in]),
                    intensity(static_cast<float>(in & 7) - 0.4f), 3e-5);
        EXPECT_EQ(warped.map->colour(id)[in], map.colour(id)[in]);
    }
}

// Two walls come to lie on each other, and one block of a third is seen at two places.
TEST(MapWarp, LeavesOutWhatCannotBeMoved) {
    BlockMap map(kWarped);
    std::vector<BlockMotion> motions(1);
    const auto add = [&](const BlockCoord& c, float shift_m, float spread_m) {
        const BlockId id = map.Allocate(c);
        std::fill_n(map.field(id), kBlockVoxels, FieldWord{0});
        motions.push_back({{shift_m, 0, 0}, spread_m, true});
    };
    add({0, 0, 0}, 0, 0);
    add({2, 0, 0}, -0.64f, 0);  // onto the first
    add({10, 0, 0}, 0, 0.039f);
    add({20, 0, 0}, 0, 0.041f);
    add({30, 0, 0}, 1.28f, 0);  // out of the box
    const WarpedMap warped = Warped(map, motions, {true, {-1, -1, -1}, {10.5, 1, 1}});
    EXPECT_EQ(warped.doubtful, (std::vector<BlockCoord>{{0, 0, 0}, {20, 0, 0}}));
    EXPECT_EQ(warped.map->count(), 1);
    EXPECT_NE(warped.map->Find({10, 0, 0}), kUnknownBlock);
}

// Blocks that are fused again get what all stored frames say at the new poses; the others stay.
TEST(MapWarp, WhatIsLeftOutIsFusedAgain) {
    const Eigen::Isometry3d moved = Se3Exp((Vector6d() << 0, 0, 0, 0.24, 0, 0).finished());
    FrameStore store(100000000, 5000);
    for (int i = 0; i < 4; ++i)
        ASSERT_TRUE(store.Add(WarpFrame(i), 0, i == 0, WarpPose(i), {}).ok());
    FieldSettings settings;
    settings.camera = SmallCamera();
    settings.map = kWarped;
    BlockMap map(kWarped);
    FuseFrames(map, 4);
    map.EnableLabels();
    for (BlockId id = 1; id < map.size(); ++id)
        for (int in = 0; in < kBlockVoxels; ++in) map.label(id)[in].instance = 9;
    std::vector<BlockMotion> motions = SameMotion(map, {0.24f, 0, 0});
    for (std::size_t id = 1; id < motions.size(); id += 5) motions[id].spread_m = 1;
    const WarpedMap warped = Warped(map, motions);
    std::vector<std::pair<BlockCoord, std::vector<FieldWord>>> kept;
    for (BlockId id = 1; id < warped.map->size(); ++id)
        kept.push_back(
            {warped.map->coord(id), {warped.map->field(id), warped.map->field(id) + kBlockVoxels}});
    BlockMap fresh(kWarped);
    for (const BlockCoord& c : warped.doubtful) fresh.Allocate(c);
    Integrator integrator({}, SmallCamera());
    for (const StoredFrame& stored : store.frames()) {
        Frame frame;
        PreparedFrame prepared;
        Integrator::View view;
        ASSERT_TRUE(store.LoadPrepared(stored, SmallCamera(), {}, frame, prepared).ok());
        view.T_world_camera = moved * stored.T_keyframe_camera;
        integrator.Integrate(prepared, view, fresh);
    }
    MapRebuild rebuild(settings, {moved}, MapWarp(map, motions, WorldBox{}, 0.04));
    while (!rebuild.Step(store, 3).value()) continue;
    const std::unique_ptr<BlockMap> whole = rebuild.TakeMap();
    for (const auto& [c, field] : kept) {
        const BlockId id = whole->Find(c);
        ASSERT_NE(id, kUnknownBlock);
        EXPECT_TRUE(std::equal(field.begin(), field.end(), whole->field(id)));
    }
    int fused = 0, labelled = 0;
    for (const BlockCoord& c : warped.doubtful) {
        const BlockId id = whole->Find(c), same = fresh.Find(c);
        if (id == kUnknownBlock) continue;
        ++fused;
        labelled += std::ranges::any_of(std::span(whole->label(id), kBlockVoxels),
                                        [](const VoxelLabel& v) { return v.instance == 9; });
        EXPECT_TRUE(
            std::equal(fresh.weight(same), fresh.weight(same) + kBlockVoxels, whole->weight(id)));
        EXPECT_TRUE(
            std::equal(fresh.field(same), fresh.field(same) + kBlockVoxels, whole->field(id)));
    }
    EXPECT_GT(fused, 20);
    EXPECT_GT(labelled, 0.8 * fused);  // the others were not known before
    EXPECT_EQ(whole->count(), static_cast<std::int64_t>(kept.size()) + fused);
}

}  // namespace
}  // namespace tessera
