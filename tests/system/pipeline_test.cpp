#include "system/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/box_room.h"
#include "synth/synthetic_source.h"
#include "system/room_frames.h"

namespace tessera {
namespace {

using testing_support::SmallCamera;
using testing_support::SmoothPath;

TEST(Pipeline, FollowsASmoothPath) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    double worst_m = 0;
    for (int i = 0; i < 40; ++i) {
        const FrameReport report = pipeline.Process(RoomFrame(i));
        ASSERT_EQ(report.track.status, TrackStatus::kGood) << i << ": " << report.track.reason;
        EXPECT_TRUE(report.fused);
        // The world frame is the first camera's.
        const Eigen::Isometry3d truth = SmoothPath(0).inverse() * SmoothPath(i);
        worst_m =
            std::max(worst_m, (truth.inverse() * report.track.T_world_camera).translation().norm());
    }
    EXPECT_LT(worst_m, 0.004);
}

TEST(Pipeline, GivenPosesAreFusedAndNotTracked) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    for (int i = 0; i < 5; ++i) {
        const FrameReport report = pipeline.Process(RoomFrame(i), SmoothPath(10 * i));
        EXPECT_TRUE(report.fused);
        EXPECT_EQ(report.track.iterations, 0);
        EXPECT_TRUE(report.track.T_world_camera.isApprox(SmoothPath(10 * i)));
    }
}

// A plan has switched the method; the window's settings are all sent when any of them changes.
TEST(Pipeline, SettingsChangeTheMethodOnlyWhereTheUserChoseOne) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    EXPECT_EQ(pipeline.Process(RoomFrame(0)).method, TrackingMethod::kSdf);
    pipeline.Select(TrackingMethod::kIcp);
    ViewerSettings settings;
    settings.prealign = false;
    pipeline.Apply(settings);
    EXPECT_EQ(pipeline.Process(RoomFrame(1)).method, TrackingMethod::kIcp);
    settings.method = TrackingMethod::kSdfGeometric;
    settings.method_choices = 1;
    pipeline.Apply(settings);
    const FrameReport report = pipeline.Process(RoomFrame(2));
    EXPECT_EQ(report.method, TrackingMethod::kSdfGeometric);
    EXPECT_EQ(report.method_choices, 1);
    pipeline.Select(TrackingMethod::kIcp);
    pipeline.Apply(settings);
    EXPECT_EQ(pipeline.Process(RoomFrame(3)).method, TrackingMethod::kIcp);
}

// With a memory limit, what stays in memory is planned for the configured depth.
TEST(Pipeline, TheLargestDepthIsNotRaisedWhereMemoryIsLimited) {
    Frame frame = RoomFrame(0);
    frame.depth_m = DepthImage(160, 120, 4.0f);
    for (const double limit_mb : {0.0, 100.0}) {
        PipelineConfig config = SmallConfig();
        config.frame.max_depth_m = 3;
        config.memory_limit_mb = limit_mb;
        TrackingStage tracking(config, SmallCamera());
        const BlockMap map(config.map);
        const auto seen = [&](double max_depth_m, bool told) {
            ViewerSettings settings;
            settings.max_depth_m = max_depth_m;
            EXPECT_EQ(tracking.Apply(settings).empty(), !told) << max_depth_m;
            TrackedFrame tracked;
            tracking.Track(frame, map, std::nullopt, tracked);
            EXPECT_EQ(tracked.prepared.limit_m,
                      limit_mb > 0 ? std::min(max_depth_m, 3.0) : max_depth_m);
            return tracked.report.valid_depth_fraction;
        };
        EXPECT_EQ(seen(9, limit_mb > 0), limit_mb > 0 ? 0 : 1);
        EXPECT_EQ(seen(9, false), limit_mb > 0 ? 0 : 1);
        frame.depth_m = DepthImage(160, 120, 2.5f);
        EXPECT_EQ(seen(3, false), 1);
        EXPECT_EQ(seen(2, false), 0);
        frame.depth_m = DepthImage(160, 120, 4.0f);
    }
}

TEST(Pipeline, AFrameWithoutColourIsTrackedByItsShape) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    for (int i = 0; i < 10; ++i) {
        Frame frame = RoomFrame(i);
        if (i % 3 == 1) frame.colour = {};
        ASSERT_EQ(pipeline.Process(frame).track.status, TrackStatus::kGood) << i;
    }
}

// Position error in metres at the end of a sequence in which two people are in view and walk from
// the first frame on.
double OffAmongPeople(double even_within_m) {
    SynthConfig synthetic;
    synthetic.camera = {320, 240, 262.5, 262.5, 159.5, 119.5};
    synthetic.fps = 30;
    synthetic.sensor.noise = NoiseModel::kKinect;
    auto source = OpenSynthetic("people", synthetic);
    PipelineConfig config;
    config.trackers.even_within_m = even_within_m;
    Pipeline pipeline(config, synthetic.camera);
    constexpr int kStart = 345, kFrames = 60;
    Eigen::Isometry3d T_world_start, T_off = Eigen::Isometry3d::Identity();
    source.value()->Seek(kStart);
    for (Frame frame;
         frame.index < kStart + kFrames && source.value()->Read(frame).status == ReadStatus::kOk;) {
        if (frame.index == kStart) T_world_start = *frame.T_world_camera;
        const FrameReport report = pipeline.Process(frame);
        T_off =
            report.track.T_world_camera.inverse() * T_world_start.inverse() * *frame.T_world_camera;
    }
    return T_off.translation().norm();
}

TEST(Pipeline, FollowsTheRoomNotWhoWalksThroughIt) {
    EXPECT_LT(OffAmongPeople(PipelineConfig().trackers.even_within_m), 0.02);
    EXPECT_GT(OffAmongPeople(0), 0.1);
}

}  // namespace
}  // namespace tessera
