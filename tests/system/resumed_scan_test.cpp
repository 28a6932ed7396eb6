// Runs in the box room that go on with a saved scan.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "optimize/scan_parts.h"
#include "run/open_source.h"
#include "support/box_room_source.h"
#include "system/frame_tracking.h"
#include "system/resume_gate.h"
#include "system/scan_fixture.h"
#include "system/scan_stage.h"

namespace tessera {
namespace {

using testing_support::BoxRoomSource;

// The map, poses, motion, brightness and shutter of a resumed run are byte for byte those of an
// uninterrupted run. With an interval of 0 the checkpoint of the last frame precedes the final one,
// which then has nothing new to write.
class ResumedScan : public Scan, public testing::WithParamInterface<double> {};

TEST_P(ResumedScan, IsTheUnbrokenOne) {
    const TriangleMesh unbroken = Run(false, {}, {.count = 40});
    const auto expected = std::move(outcomes);
    config.scan.interval_s = GetParam();
    Run(false, New(), {.count = 17});
    stop = true;
    Run(false, Again(), {.count = 40}, 17);  // stopped before its first frame
    stop = false;
    ScanPlan plan = Again();
    const FrameSelection rest = RestOf({}, BoxRoomSource({.count = 40}).info(), *plan.resumed);
    EXPECT_EQ(rest.start, 17);
    ExpectSame(Run(false, std::move(plan), {.count = 40}, rest.start), unbroken);
    ASSERT_EQ(Reports().size(), 23u);
    for (std::size_t i = 0; i < 23; ++i)
        EXPECT_EQ(Reports()[i]->track.T_world_camera.matrix(),
                  expected[17 + i].report.track.T_world_camera.matrix())
            << i;
    EXPECT_EQ(Content().path.size(), 40u);
}

INSTANTIATE_TEST_SUITE_P(CheckpointsInterval, ResumedScan, testing::Values(0.0, 1.0));

TEST_F(Scan, LiveASavedScanIsGoneOnWith) {
    const double speed = 1;
    config.live.playback_speed = 1;
    config.live.queue_frames = 30;  // no frame is dropped, even on a slow machine
    Run(true, New(), {.count = 20, .speed = speed});
    const ScanContent first = Content();
    ASSERT_GT(first.path.size(), 5u);
    EXPECT_TRUE(first.finished);
    Run(true, Again(), {.count = 40, .speed = speed}, first.progress.last_index + 1);
    ASSERT_FALSE(Reports().empty());
    for (const FrameReport* report : Reports()) {
        EXPECT_FALSE(report->first);
        ASSERT_TRUE(report->tracked()) << report->index << " " << report->track.reason;
        EXPECT_LT(Error_m(*report, speed), 0.01) << report->index;
    }
    EXPECT_EQ(Content().path.size(), first.path.size() + Reports().size());
}

// After a gap only a good fit is accepted. Until then the map does not change.
TEST_F(Scan, AfterAGapTheCameraIsFoundWhereTheScanEndedAndNowhereElse) {
    config.loops.enabled = false;  // which would find it elsewhere, too
    // With this colour weight the tracker first converges to a wrong pose, which the gate must
    // refuse.
    config.pipeline.trackers.photometric.alpha_mode = ResidualModel::AlphaMode::kFixed;
    config.pipeline.trackers.photometric.alpha = 0.05;
    Run(false, New(), {.count = 20});
    const BlockId blocks = Content().map->size();
    // 13 s later: first some rotated and moved views, then one near the last view.
    Run(false, Again(), {.count = 420, .speed = 6}, 400);
    const auto tracked = std::ranges::count_if(
        Reports(), [](const FrameReport* report) { return report->tracked(); });
    EXPECT_FALSE(Reports().front()->tracked());
    EXPECT_LE(tracked, 16);  // of 20: the first four converge to a wrong pose and are refused
    for (const FrameReport* report : Reports())
        EXPECT_TRUE(!report->tracked() || Error_m(*report, 6) < 0.005)
            << report->index << " " << Error_m(*report, 6);
    EXPECT_TRUE(tracked > 0 || Content().map->size() == blocks);
    // Resume where the scan ended, with views near frame 19.
    config.scan.interval_s = 0.1;
    Run(false, Again(), {.count = 30}, 15);
    ASSERT_FALSE(Reports().empty());
    EXPECT_TRUE(Reports().back()->fused);
    EXPECT_LT(Error_m(*Reports().back()), 0.01);
}

// A part of the scan had begun, and nothing was tracked in it yet. The next frame must not begin
// one where the first did.
TEST(ResumeGate, AStateWithoutAPoseStartsAtTheScansLast) {
    const StampedPose last{3.5, Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3))};
    TrackingStage ended({}, testing_support::SmallCamera());
    ended.StartAt(last);
    ended.BeginPart(PartStart(1));
    Bytes saved;
    StateWriter state(saved);
    ended.SaveState(state);
    TrackingStage resumed({}, testing_support::SmallCamera());
    ResumeGate(0.5).Begin(saved, last, resumed);
    ASSERT_TRUE(resumed.last().has_value());
    EXPECT_EQ(resumed.last()->stamp_s, 3.5);
    EXPECT_EQ(resumed.last()->T_world_camera.matrix(), last.T_world_camera.matrix());
}

// The last correction came after the state was saved.
TEST(ResumeGate, AStateFromBeforeACorrectionMovesToTheScansLastPose) {
    const Eigen::Isometry3d T_saved(Eigen::Translation3d(1, 2, 3));
    TrackingStage ended({}, testing_support::SmallCamera());
    ended.StartAt({3.5, T_saved});
    Bytes saved;
    StateWriter state(saved);
    ended.SaveState(state);
    Eigen::Isometry3d T_corrected = T_saved * Eigen::Translation3d(0.3, 0, -0.1);
    T_corrected.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()));
    // One that differs by rounding is kept as it is; of another frame's nothing is known.
    const Eigen::Isometry3d T_rounded = T_saved * Eigen::Translation3d(1e-12, 0, 0);
    for (const auto& [last, expected] : {std::pair(StampedPose{3.5, T_corrected}, T_corrected),
                                         std::pair(StampedPose{3.5, T_rounded}, T_saved),
                                         std::pair(StampedPose{3.4, T_corrected}, T_saved)}) {
        TrackingStage resumed({}, testing_support::SmallCamera());
        ResumeGate(0.5).Begin(saved, last, resumed);
        ASSERT_TRUE(resumed.last().has_value());
        EXPECT_LT((resumed.last()->T_world_camera.matrix() - expected.matrix()).norm(), 1e-13);
    }
}

// The clock of a loss starts with the last frame that was tracked, not with the last one.
TEST(TrackingResume, TellsWhenTheCameraWasSeenLast) {
    ScanPlan plan;
    ScanContent& scan = plan.resumed.emplace();
    for (const double stamp_s : {10.0, 14.0}) {
        PathRecord record;
        record.stamp_s = scan.progress.last_stamp_s = stamp_s;
        record.status = stamp_s < 12 ? TrackStatus::kPoor : TrackStatus::kLost;
        scan.path.push_back(record);
    }
    EXPECT_EQ(TrackingResume::Of(plan).last_seen_s, 10);
    EXPECT_TRUE(TrackingResume::Of(plan).lost);
    scan.path.back().status = TrackStatus::kPoor;
    EXPECT_EQ(TrackingResume::Of(plan).last_seen_s, 14);
    EXPECT_FALSE(TrackingResume::Of(plan).lost);
}

TEST_F(Scan, WhatContradictsTheFileIsRefusedByItsKey) {
    Run(false, New(), {.count = 4});
    ConfigParameters parameters;
    RunConfig other;
    other.Describe(parameters);
    ASSERT_TRUE(TakeScanKeys(path, parameters).ok());
    EXPECT_EQ(other.pipeline.map.voxel_size_m, 0.02);
    EXPECT_TRUE(CheckScanKeys(path, parameters).ok());
    ASSERT_TRUE(parameters.Set("mapping.voxel_size_m", "0.01").ok());
    const Status refused = CheckScanKeys(path, parameters);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.message().find("mapping.voxel_size_m"), 0u) << refused.message();
}

TEST_F(Scan, AnotherCameraIsRefusedByWhatDiffers) {
    Run(false, New(), {.count = 2});
    SourceInfo other = testing_support::BoxRoomSource().info();
    const PinholeCamera was = other.camera;
    other.name = "another";
    other.camera.fy += 0.001;
    other.camera.cx -= 0.001;
    const Result<ScanPlan> plan = ResumeScan(path, other, config, false);
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.message(),
              fmt::format("{}: was made with a camera of fy {}, cx {}, but another has fy {}, "
                          "cx {}; use the same camera, or start another scan",
                          path, was.fy, was.cx, other.camera.fy, other.camera.cx));
}

TEST_F(Scan, OfTheSameRecordingOnlyTheRestIsRead) {
    ScanContent scan;
    scan.source_name = "box room";
    scan.progress.last_index = 17;
    SourceInfo info;
    info.name = "box room";
    info.frame_count = 40;
    const auto rest = [&](const FrameSelection& s) {
        const FrameSelection r = RestOf(s, info, scan);
        return std::array{r.start, r.count, r.stride};
    };
    using Rest = std::array<std::int64_t, 3>;
    EXPECT_EQ(rest({}), (Rest{18, -1, 1}));
    EXPECT_EQ(rest({0, 25, 1}), (Rest{18, 7, 1}));
    EXPECT_EQ(rest({1, -1, 4}), (Rest{21, -1, 4}));
    EXPECT_EQ(rest({30, -1, 1}), (Rest{30, -1, 1}));
    EXPECT_EQ(rest({0, 10, 1})[1], 0);
    info.frame_count = 18;
    EXPECT_EQ(rest({})[1], 0);
    info.name = "another";
    EXPECT_EQ(rest({}), (Rest{0, -1, 1}));
}

TEST_F(Scan, ARecordingIsTheSameUnderAnyOfItsNames) {
    namespace fs = std::filesystem;
    const std::string d1 = folder / "d1";
    for (const char* name : {"d1", "d2"}) fs::create_directory(folder / name);
    ScanContent scan;
    scan.source_name = d1;
    scan.progress.last_index = 17;
    const auto first = [&](const std::string& name) {
        SourceInfo info;
        info.name = name;
        return RestOf({}, info, scan).start;
    };
    EXPECT_EQ(first(d1), 18);
    EXPECT_EQ(first(d1 + "/"), 18);
    EXPECT_EQ(first(folder / "./d2/../d1"), 18);
    EXPECT_EQ(first(fs::relative(d1).string()), 18);
    EXPECT_EQ(first(folder / "d2"), 0);
    EXPECT_EQ(first(folder / "none"), 0);
    scan.source_name = folder / "gone";
    EXPECT_EQ(first(folder / "gone"), 18);
    EXPECT_EQ(first(d1), 0);
}

}  // namespace
}  // namespace tessera
