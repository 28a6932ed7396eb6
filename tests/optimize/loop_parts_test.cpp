// Scans in parts: walks through a rendered room with Kinect noise, of which the second begins
// elsewhere in the map.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/se3.h"
#include "mapping/map_delta.h"
#include "optimize/drifting_walk.h"
#include "optimize/loop_closer.h"
#include "optimize/part_walk.h"

namespace tessera {
namespace {

using namespace testing_support;

// The fields of all blocks by their coordinates, seen from that many blocks along x.
using Fields = std::map<std::array<int, 3>, std::vector<FieldWord>>;
Fields FieldsFrom(int blocks, const BlockMap& map) {
    Fields fields;
    for (BlockId id = 1; id < map.size(); ++id) {
        const BlockCoord c = map.coord(id);
        if (map.IsFree(id)) continue;
        fields[{c.x - blocks, c.y, c.z}].assign(map.field(id), map.field(id) + kBlockVoxels);
    }
    return fields;
}

bool AreAmong(const Fields& some, const Fields& all) {
    return std::ranges::all_of(some, [&](const auto& block) {
        const auto found = all.find(block.first);
        return found != all.end() && found->second == block.second;
    });
}

std::vector<Frame> Both(std::vector<Frame> frames, const std::vector<Frame>& more) {
    frames.insert(frames.end(), more.begin(), more.end());
    return frames;
}

struct LoopParts : testing::Test {
    void SetUp() override {
        if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    }
};

TEST_F(LoopParts, AreJoinedWhereTheCameraSeesAPlaceOfTheOther) {
    const std::vector<Frame> first = RoomWalk(0, 16, 6), second = RoomWalk(180, 30, -6);
    // The map is fused again, or moved, which is hardly worse.
    double fused_off_m = 0;
    for (const bool moves : {false, true}) {
        Walker walker(LoopConfig{});
        walker.moves_map = moves;
        Walk(walker, first, 0);
        Walk(walker, second, 1);
        EXPECT_NE(walker.all_news.find("is joined with"), std::string::npos) << walker.all_news;
        EXPECT_GE(walker.corrections, 1);
        EXPECT_LT(FarthestFrom(Eigen::Vector3d::Zero(), *walker.map), 10);
        const double off_m = MeanOff_m(second.back(), walker) + MeanOff_m(first[5], walker);
        if (moves)
            EXPECT_LT(off_m, fused_off_m + 0.001);
        else
            fused_off_m = off_m;
        EXPECT_LT(fused_off_m, 0.02);  // one voxel: depth of 3 m scatters by half of one
        std::string note;
        walker.Take(walker.closer.Finish(note));
        EXPECT_EQ(note, "");
        const std::vector<StampedPose> path = walker.closer.Path();
        ASSERT_EQ(path.size(), first.size() + second.size());
        EXPECT_LT(FarthestOff(path, Both(first, second)), 0.015);
        EXPECT_LT(FarthestFrom(Eigen::Vector3d::Zero(), *walker.map), 10);
        // The camera went on from where it had come to be.
        EXPECT_LT((walker.T_map_camera.translation() - second.back().T_world_camera->translation())
                      .norm(),
                  0.015);
    }
}

// The path and the map are those of the longer part, in the world of its first camera.
void ExpectTheShorterPartIsLeftOut(bool moves) {
    for (const bool second_is_longer : {false, true}) {
        const std::vector<Frame> first = RoomWalk(0, 14, 3),
                                 second = RoomWalk(360, second_is_longer ? 20 : 12, 3);
        Walker walker(LoopConfig{});
        Walk(walker, first, 0);
        Walk(walker, second, 1);
        std::string note;
        const double block_m = kBlockSide * walker.map->config().voxel_size_m;
        const int apart = static_cast<int>(std::lround(kPartsApart_m / block_m));
        const Fields before = FieldsFrom(second_is_longer ? apart : 0, *walker.map);
        walker.Take(walker.closer.Finish(note, moves ? walker.map.get() : nullptr));
        // Whole blocks are moved as they are. Frames that are fused again give other voxels.
        EXPECT_EQ(AreAmong(FieldsFrom(0, *walker.map), before), moves);
        EXPECT_EQ(note.find(second_is_longer ? "14 frames are left out" : "12 frames are left out"),
                  0u)
            << note;
        const std::vector<Frame>& kept = second_is_longer ? second : first;
        const std::vector<StampedPose> path = walker.closer.Path();
        ASSERT_EQ(path.size(), kept.size());
        EXPECT_TRUE(path.front().T_world_camera.isApprox(Eigen::Isometry3d::Identity(), 1e-6));
        EXPECT_LT(FarthestOff(path, kept), 1e-6);
        EXPECT_GT(walker.map->size(), 100);
        EXPECT_LT(FarthestFrom(Eigen::Vector3d::Zero(), *walker.map), 10);
        EXPECT_LT(MeanOff_m(kept[10], path[10].T_world_camera, walker), 0.02);
    }
}

TEST_F(LoopParts, AShorterPartThatIsNotJoinedIsLeftOut) { ExpectTheShorterPartIsLeftOut(false); }

TEST_F(LoopParts, AndRemovedFromTheMapInUse) { ExpectTheShorterPartIsLeftOut(true); }

// A loop that was just closed when the run ends, in the part that is kept.
TEST_F(LoopParts, WhatIsKeptIsThenMovedToWhereItsGraphIs) {
    Walker walker(LoopConfig{});
    Walk(walker, RoomWalk(360, 8, 3), 0);  // so short that no camera is found there
    const std::vector<Frame> round = RoomWalk(0, 120, 6);
    const auto drifted = [&](std::size_t i) {
        const double share = std::clamp((static_cast<double>(i) - 60) / 10, 0.0, 1.0);
        const Vector6d drift = (Vector6d() << 0, 0.1, 0, 0.15, 0, 0.2).finished() * share;
        return Normalised(Se3Exp(drift) * *round[i].T_world_camera);
    };
    std::size_t count = 0;
    for (; count < round.size() && walker.all_news.empty(); ++count) {
        if (count == 0) walker.T_map_camera = PartStart(1);
        walker.Go(round[count], count == 0 ? Eigen::Isometry3d::Identity()
                                           : drifted(count - 1).inverse() * drifted(count));
    }
    ASSERT_LT(count, round.size());
    ASSERT_EQ(walker.corrections, 0);
    std::string note;
    walker.Take(walker.closer.Finish(note, walker.map.get()));
    EXPECT_EQ(note.find("8 frames are left out"), 0u) << note;
    const std::vector<StampedPose> path = walker.closer.Path();
    ASSERT_EQ(path.size(), count);
    EXPECT_LT(FarthestFrom(Eigen::Vector3d::Zero(), *walker.map), 10);
    EXPECT_LT(MeanOff_m(round[count - 1], path.back().T_world_camera, walker), 0.02);
    const Eigen::Isometry3d off = path.back().T_world_camera.inverse() * walker.T_map_camera;
    EXPECT_LT(off.translation().norm(), 0.03);
}

TEST_F(LoopParts, AMapMadeOutsideARunHasTheLargestOnly) {
    Walker walker(LoopConfig{});
    Walk(walker, RoomWalk(0, 12, 3), 0);
    Walk(walker, RoomWalk(360, 20, 3), 1);
    const Result<LoopCloser::Correction> made = walker.closer.MakeAgain();
    ASSERT_TRUE(made.ok()) << made.message();
    EXPECT_GT(made.value().map->size(), 100);
    EXPECT_LT(FarthestFrom(Eigen::Vector3d::Zero(), *made.value().map), 10);
    EXPECT_EQ(walker.closer.Path().size(), 20u);
}

TEST_F(LoopParts, AHandfulOfFramesIsNoPlaceToBeFoundAt) {
    for (const int count : {10, 11}) {
        const std::vector<Frame> first = RoomWalk(0, count, 3);
        Walker walker(LoopConfig{});
        Walk(walker, first, 0);
        PreparedFrame prepared;
        PrepareFrame(first[4], walker.settings.preparation, prepared);
        std::string note;
        EXPECT_TRUE(walker.closer.Relocalise(first[4].stamp_s, prepared, note)) << count;
        Walk(walker, RoomWalk(360, 1, 3), 1);
        EXPECT_EQ(walker.closer.Relocalise(first[4].stamp_s, prepared, note).has_value(),
                  count > 10)
            << count;
    }
}

// A lost camera finds its place in both parts, which says how they lie. One view may be of another
// room of the same kind.
TEST_F(LoopParts, AreJoinedByALostCameraThatIsFoundInBoth) {
    Walker walker(LoopConfig{});
    walker.closer.SetSeeking(false);
    Walk(walker, RoomWalk(0, 20, 6), 0);
    Walk(walker, RoomWalk(0, 15, 8), 1);
    walker.closer.SetSeeking(true);
    std::string note;
    PreparedFrame prepared;
    const auto relocalise = [&](int frame, const std::optional<Eigen::Isometry3d>& expected = {}) {
        const Frame view = RoomWalk(frame, 1, 1)[0];
        PrepareFrame(view, walker.settings.preparation, prepared);
        return walker.closer.Relocalise(view.stamp_s, prepared, note, expected);
    };
    const auto in_second = relocalise(9, PartStart(1));
    ASSERT_TRUE(in_second) << note;
    EXPECT_TRUE(InOnePart(in_second->T_map_camera, PartStart(1)));
    EXPECT_EQ(note.find("joined"), std::string::npos) << note;
    const auto found = relocalise(9);
    ASSERT_TRUE(found) << note;
    EXPECT_TRUE(InOnePart(found->T_map_camera, PartStart(0))) << "which has more keyframes";
    EXPECT_EQ(note.find("joined"), std::string::npos) << note;
    ASSERT_TRUE(relocalise(100)) << note;
    EXPECT_NE(note.find("is joined with"), std::string::npos) << note;
    EXPECT_EQ(PartsOf(walker.closer.graph().edges(), walker.closer.keyframes().all()),
              std::vector<int>(static_cast<std::size_t>(walker.closer.keyframes().size()), 0));
}

// What was fused since the map in use was copied follows the camera, but not to another place.
TEST_F(LoopParts, AMapThatIsMovedIsAskedForAgainIfTheCameraIsElsewhere) {
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    walker.moves_map = true;
    LoopCloser& closer = walker.closer;
    for (std::size_t i = 0; i < frames.size() && !closer.MovesMap(); ++i) {
        Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
        if (i > 0)
            step = frames[i - 1].T_world_camera->inverse() * *frames[i].T_world_camera * Bias();
        walker.Go(frames[i], step);
    }
    const auto fuse = [&] { closer.Pass(100, walker.T_map_camera, true); };
    ASSERT_TRUE(closer.MovesMap());
    closer.LinkNextTo(0);
    EXPECT_FALSE(closer.WantsMap()) << "the copy has all that was fused";
    fuse();
    EXPECT_FALSE(closer.WantsMap());
    closer.LinkNextTo(0);
    EXPECT_TRUE(closer.WantsMap());
    closer.Move(CopyLayers(*walker.map, BlockMap::Layers::kAll));
    fuse();
    EXPECT_FALSE(closer.WantsMap());
    closer.Pass(101, PartStart(1), true);  // of a new part
    EXPECT_TRUE(closer.WantsMap());
}

}  // namespace
}  // namespace tessera
