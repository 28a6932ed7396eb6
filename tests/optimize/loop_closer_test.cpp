// Complete walks through a rendered room with Kinect noise.
#include "optimize/loop_closer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "optimize/drifting_walk.h"
#include "optimize/room_walk.h"

namespace tessera {
namespace {

using testing_support::Bias;
using testing_support::EndError_m;
using testing_support::RoomCamera;
using testing_support::RoomSettings;
using testing_support::RoomWalk;
using testing_support::Round;
using testing_support::Walker;
using testing_support::WalkWithDrift;

TEST(LoopCloser, TakesAFifthOrLessOfTheDriftToTheEndAndTheMapFollows) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    LoopConfig off;
    off.min_votes = 1000;  // too many votes for any candidate, so no loops
    off.overlaps = false;
    Walker without(off), with(LoopConfig{});
    WalkWithDrift(frames, without);
    WalkWithDrift(frames, with);
    std::string note;
    with.Take(with.closer.Finish(note));
    EXPECT_EQ(note, "");
    const double before_m = EndError_m(frames, without.closer.Path()),
                 after_m = EndError_m(frames, with.closer.Path());
    RecordProperty("before_mm", std::to_string(1000 * before_m));
    RecordProperty("after_mm", std::to_string(1000 * after_m));
    std::cout << "end-point error " << 1000 * before_m << " mm without, " << 1000 * after_m
              << " mm with; " << with.closer.graph().loops() << " loops, "
              << with.closer.keyframes().size() << " keyframes\n"
              << with.all_news;
    EXPECT_GT(before_m, 0.07);
    EXPECT_LE(after_m, before_m / 5);
    EXPECT_GE(with.corrections, 1);
    EXPECT_EQ(without.corrections, 0);

    // Compare the map with a fresh fusion of the original frames at the final poses.
    BlockMap fresh(with.settings.map);
    Integrator integrator(with.settings.fusion, RoomCamera());
    const std::vector<StampedPose> path = with.closer.Path();
    ASSERT_EQ(path.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        PreparedFrame prepared;
        PrepareFrame(frames[i], with.settings.preparation, prepared);
        Integrator::View view;
        view.T_world_camera = path[i].T_world_camera;
        integrator.Integrate(prepared, view, fresh);
    }
    std::vector<float> off_voxels;
    const float voxels =
        static_cast<float>(with.settings.map.truncation_m / with.settings.map.voxel_size_m);
    for (BlockId id = 1; id < fresh.size(); ++id) {
        const BlockId other = with.map->Find(fresh.coord(id));
        for (int v = 0; v < kBlockVoxels && other != kUnknownBlock; ++v)
            if (HasDistance(fresh.field(id)[v]) && HasDistance(with.map->field(other)[v]) &&
                std::abs(FieldDistance(fresh.field(id)[v])) < 0.5f)
                off_voxels.push_back(voxels * std::abs(FieldDistance(fresh.field(id)[v]) -
                                                       FieldDistance(with.map->field(other)[v])));
    }
    ASSERT_GT(off_voxels.size(), 10000u);
    std::ranges::sort(off_voxels);
    const float p95 = off_voxels[off_voxels.size() * 95 / 100];
    std::cout << "map against a fresh fusion: 95th percentile " << p95 << " voxels\n";
    EXPECT_LE(p95, 0.5f);
}

// A drift of 1.7 cm is more than a voxel of 1 cm and less than one of 4 cm: what the map cannot
// show is left to tracking.
TEST(LoopCloser, CorrectsWhatTheMapCanShow) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    FieldSettings fine = RoomSettings(), coarse = fine;
    fine.map = {.voxel_size_m = 0.01, .truncation_m = 0.04};
    coarse.map = {.voxel_size_m = 0.04, .truncation_m = 0.16};
    Walker in_fine(LoopConfig{}, fine), in_coarse(LoopConfig{}, coarse);
    for (Walker* walker : {&in_fine, &in_coarse}) {
        WalkWithDrift(frames, *walker, 0.2);
        std::string note;
        int freed = 0;
        auto correction = walker->closer.Finish(note, nullptr, [&freed] { ++freed; });
        EXPECT_EQ(freed, correction ? 1 : 0);
        walker->Take(std::move(correction));
        std::cout << 1000 * EndError_m(frames, walker->closer.Path()) << " mm, "
                  << walker->corrections << " corrections\n"
                  << walker->all_news;
    }
    EXPECT_LE(EndError_m(frames, in_fine.closer.Path()), 0.008);
    EXPECT_TRUE(in_fine.closer.graph().corrected());
    EXPECT_FALSE(in_coarse.closer.graph().corrected());
}

// Tracking drifts by half a metre and ten degrees, which is more than a walk of 4 m explains,
// from frame `first` on in so many steps.
void ExpectALargeDriftIsClosed(int first, int steps) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    const auto drifted = [&](std::size_t i) {
        const double share = std::clamp((static_cast<double>(i) - first) / steps, 0.0, 1.0);
        const Vector6d drift = (Vector6d() << 0, 0.1745, 0, 0.3, 0.1, 0.39).finished() * share;
        return Normalised(Se3Exp(drift) * *frames[i].T_world_camera);
    };
    for (std::size_t i = 0; i < frames.size(); ++i)
        walker.Go(frames[i],
                  i == 0 ? Eigen::Isometry3d::Identity() : drifted(i - 1).inverse() * drifted(i));
    std::string note;
    walker.Take(walker.closer.Finish(note));
    const double before_m = (drifted(frames.size() - 1).translation() -
                             frames.back().T_world_camera->translation())
                                .norm(),
                 after_m = EndError_m(frames, walker.closer.Path());
    std::cout << "end-point error " << 1000 * before_m << " mm without, " << 1000 * after_m
              << " mm with\n"
              << walker.all_news;
    EXPECT_GT(before_m, 0.45);
    EXPECT_LE(after_m, 0.02);
    EXPECT_GE(walker.corrections, 1);
}

TEST(LoopCloser, FindsAndClosesALargeSlip) { ExpectALargeDriftIsClosed(60, 10); }

// Each alignment with a neighbour then contradicts tracking.
TEST(LoopCloser, FindsAndClosesALargeSteadyDrift) { ExpectALargeDriftIsClosed(0, 119); }

TEST(LoopCloser, SwitchedOffItClosesNothingUntilItIsOnAgain) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    for (const bool on_again : {false, true}) {
        Walker walker(LoopConfig{});
        walker.closer.SetSeeking(false);
        const auto step = [&](std::size_t i) {
            return Eigen::Isometry3d(frames[i - 1].T_world_camera->inverse() *
                                     *frames[i].T_world_camera * Bias());
        };
        for (std::size_t i = 0; i < frames.size(); ++i) {
            EXPECT_FALSE(walker.closer.HasWork());
            walker.Go(frames[i], i == 0 ? Eigen::Isometry3d::Identity() : step(i));
        }
        EXPECT_EQ(walker.corrections, 0);
        walker.closer.SetSeeking(on_again);
        for (std::size_t i = 1; i < 30; ++i) walker.Go(frames[i], step(i));
        std::string note;
        walker.Take(walker.closer.Finish(note));
        EXPECT_EQ(walker.corrections > 0, on_again);
        EXPECT_EQ(walker.closer.graph().loops() > 0, on_again);
    }
}

// Loops between keyframes in different rooms, which are 6 m apart.
int FalseLoops(const LoopCloser& closer) {
    return static_cast<int>(
        std::ranges::count_if(closer.graph().edges(), [&](const PoseEdge& edge) {
            const Eigen::Isometry3d &a = closer.keyframes()[edge.from].T_map_camera,
                                    &b = closer.keyframes()[edge.to].T_map_camera;
            return edge.loop && (a.translation() - b.translation()).norm() > 3;
        }));
}

// The second room repeats the images of the first one. Only the path between them distinguishes
// them.
TEST(LoopCloser, TwoIdenticalRoomsAreNotOne) {
    const std::vector<Frame> frames = RoomWalk(0, 20, 6);
    for (const double max_drift : {0.05, 10.0}) {
        LoopConfig config;
        config.max_drift = max_drift;
        config.min_gap = 2;
        Walker walker(config);
        for (int room = 0; room < 2; ++room)
            for (std::size_t i = 0; i < frames.size(); ++i)
                walker.Go(frames[i], i > 0 ? frames[i - 1].T_world_camera->inverse() *
                                                 *frames[i].T_world_camera
                                     : room == 0 ? Eigen::Isometry3d::Identity()
                                                 : frames.back().T_world_camera->inverse() *
                                                       Eigen::Translation3d(6, 0, 0));
        if (max_drift < 1)
            EXPECT_EQ(FalseLoops(walker.closer), 0) << walker.all_news;
        else
            EXPECT_GT(FalseLoops(walker.closer) + walker.corrections, 0)
                << "without the gate there must be false loops";
        if (max_drift > 1) continue;
        // After a tracking loss the camera could be in either room.
        PreparedFrame prepared;
        PrepareFrame(frames[8], walker.settings.preparation, prepared);
        std::string note;
        EXPECT_FALSE(walker.closer.Relocalise(frames[8].stamp_s, prepared, note).has_value());
        EXPECT_NE(note.find("ambiguous"), std::string::npos) << note;
    }
}

TEST(LoopCloser, FindsALostCameraToTheCentimetreAndRefusesAnUnknownPlace) {
    const std::vector<Frame> seen = RoomWalk(0, 30, 6);
    Walker walker(LoopConfig{});
    for (std::size_t i = 0; i < seen.size(); ++i)
        walker.Go(seen[i], i == 0
                               ? Eigen::Isometry3d::Identity()
                               : seen[i - 1].T_world_camera->inverse() * *seen[i].T_world_camera);
    std::string note;
    PreparedFrame prepared;
    int found = 0;
    for (const Frame& frame : RoomWalk(15, 5, 24)) {
        PrepareFrame(frame, walker.settings.preparation, prepared);
        const auto here = walker.closer.Relocalise(frame.stamp_s, prepared, note);
        if (!here) continue;
        ++found;
        EXPECT_LT((here->T_map_camera.translation() - frame.T_world_camera->translation()).norm(),
                  0.015)
            << frame.index;
    }
    EXPECT_GE(found, 4);
    for (const Frame& frame : RoomWalk(360, 5, 24)) {  // the other side of the room
        PrepareFrame(frame, walker.settings.preparation, prepared);
        EXPECT_FALSE(walker.closer.Relocalise(frame.stamp_s, prepared, note).has_value())
            << frame.index;
    }
}

// A scan that was repaired may lack frames.
TEST(LoopCloser, FindsNoCameraAtAKeyframeWhoseFrameIsMissing) {
    const std::vector<Frame> seen = RoomWalk(0, 11, 3);
    Walker walker(LoopConfig{});
    for (std::size_t i = 0; i < seen.size(); ++i)
        walker.Go(seen[i], i == 0
                               ? Eigen::Isometry3d::Identity()
                               : seen[i - 1].T_world_camera->inverse() * *seen[i].T_world_camera);
    const LoopCloser& whole = walker.closer;
    PreparedFrame prepared;
    PrepareFrame(seen[4], walker.settings.preparation, prepared);
    std::string note;
    for (const bool missing : {false, true}) {
        const std::span<const Keyframe> keyframes = whole.keyframes().all();
        LoopCloser::Memory memory;
        memory.graph.keyframes.assign(keyframes.begin(), keyframes.end());
        memory.graph.edges = whole.graph().edges();
        memory.graph.passages = whole.graph().passages();
        memory.frames = whole.store().frames();
        memory.next_ordinal = whole.store().next_ordinal();
        if (missing)
            std::erase_if(memory.frames, [](const StoredFrame& f) { return f.is_keyframe; });
        LoopCloser resumed(LoopConfig{}, walker.settings, 5000);
        resumed.Resume(std::move(memory));
        EXPECT_EQ(resumed.Relocalise(seen[4].stamp_s, prepared, note).has_value(), !missing)
            << note;
    }
    FrameStore none(1 << 20, 5000);
    const FieldVerdict verdict = LoopVerifier(walker.settings, LoopConfig{})
                                     .VerifyPlace(whole.keyframes(), whole.keyframes()[0], prepared,
                                                  Eigen::Isometry3d::Identity(), none);
    EXPECT_FALSE(verdict.accepted);
}

TEST(DriftOf, GrowsWithTheWay) {
    Keyframe old, fresh;
    fresh.T_world_camera = Eigen::Translation3d(1, 0, 0);
    fresh.path_length_m = 10;
    const Eigen::Isometry3d measured(Eigen::Translation3d(0.4, 0, 0));
    EXPECT_DOUBLE_EQ(DriftOf(old, fresh, measured, 0.05).off_m, 0.6);
    EXPECT_TRUE(DriftOf(old, fresh, measured, 0.05).possible);  // 0.15 + 0.05 * 10
    EXPECT_FALSE(DriftOf(old, fresh, measured, 0.04).possible);
    const Eigen::Isometry3d turned = measured * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
    EXPECT_FALSE(DriftOf(old, fresh, turned, 0.05).possible);
    fresh.turned_rad = 2;
    EXPECT_TRUE(DriftOf(old, fresh, turned, 0.05).possible);
    // A metre is neither: rooms of one kind lie farther apart than what is conceivable.
    const Eigen::Isometry3d half(Eigen::Translation3d(0.3, 0, 0)),
        metre(Eigen::Translation3d(-0.4, 0, 0));
    EXPECT_FALSE(DriftOf(old, fresh, half, 0.05).possible);
    EXPECT_TRUE(DriftOf(old, fresh, half, 0.05).conceivable);
    EXPECT_FALSE(DriftOf(old, fresh, metre, 0.05).conceivable);  // 1.4 m > 0.8 + 0.05 * 10
}

// That the camera is somewhere is known before frames are added that were tracked earlier.
TEST(LoopCloser, OnlyAFrameThatWasTrackedWhereTheCameraWasFoundIsLinkedThere) {
    Walker walker(LoopConfig{});
    const std::vector<Frame> seen = RoomWalk(0, 24, 6);
    for (std::size_t i = 0; i < 20; ++i)
        walker.Go(seen[i], i == 0
                               ? Eigen::Isometry3d::Identity()
                               : seen[i - 1].T_world_camera->inverse() * *seen[i].T_world_camera);
    std::string note;
    PreparedFrame prepared;
    PrepareFrame(seen[1], walker.settings.preparation, prepared);
    const auto found = walker.closer.Relocalise(seen[19].stamp_s, prepared, note);
    ASSERT_TRUE(found) << note;
    const int last = walker.closer.keyframes().last().id;
    ASSERT_LT(found->keyframe + 1, last);
    walker.Go(RoomWalk(170, 1, 1)[0],
              seen[19].T_world_camera->inverse() * *RoomWalk(170, 1, 1)[0].T_world_camera);
    ASSERT_EQ(walker.closer.keyframes().last().id, last + 1);
    EXPECT_EQ(walker.closer.graph().edges().back().from, last);
    walker.closer.LinkNextTo(found->keyframe);
    walker.Go(seen[1], RoomWalk(170, 1, 1)[0].T_world_camera->inverse() * *seen[1].T_world_camera);
    ASSERT_EQ(walker.closer.keyframes().last().id, last + 2);
    EXPECT_TRUE(std::ranges::any_of(walker.closer.graph().edges(), [&](const PoseEdge& edge) {
        return edge.from == found->keyframe && edge.to == last + 2 && !edge.loop;
    }));
}

}  // namespace
}  // namespace tessera
