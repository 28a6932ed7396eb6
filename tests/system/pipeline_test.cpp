#include "system/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>

#include "support/box_room.h"
#include "synth/synthetic_source.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

PipelineConfig SmallConfig() {
    PipelineConfig config;
    config.map.voxel_size_m = 0.02;
    config.map.truncation_m = 0.08;
    config.trackers.sdf.finest_step_px = 1;
    return config;
}

Frame RoomFrame(int i) {
    BoxRoom room;
    room.has_ball = true;
    Frame frame = room.Render(SmallCamera(), SmoothPath(i), i / 30.0);
    frame.index = i;
    return frame;
}

void FillDepth(Frame& frame, std::uint32_t seed) {
    for (float& z : std::span(frame.depth_m.data(), frame.depth_m.size())) {
        seed = seed * 1664525u + 1013904223u;
        z = 0.3f + static_cast<float>(seed >> 8) * (4.0f / (1 << 24));
    }
}

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

// Half of the depth lies beside the map. From frame to frame the rest is enough to track by. After
// a gap the camera could be anywhere, and half a fit is no evidence.
TEST(Pipeline, AfterAGapHalfAFitIsNoEvidence) {
    for (const double gap_s : {1.0 / 30, 0.8}) {
        Pipeline pipeline(SmallConfig(), SmallCamera());
        for (int i = 0; i < 15; ++i) ASSERT_TRUE(pipeline.Process(RoomFrame(i)).fused);
        Frame frame = RoomFrame(14);
        frame.stamp_s += gap_s;
        const Frame whole = frame;
        // Strips before and behind the map in turn: no pose fits them.
        for (int y = 0; y < frame.depth_m.height(); ++y)
            for (int x = 0; x < frame.depth_m.width() / 2; ++x)
                frame.depth_m(x, y) += y / 8 % 2 == 0 ? 0.06f : -0.06f;
        const FrameReport report = pipeline.Process(frame);
        EXPECT_LT(report.track.inlier_fraction, 0.75);
        EXPECT_GT(report.track.inlier_fraction, 0.4);
        if (gap_s < 0.1) {
            EXPECT_EQ(report.track.status, TrackStatus::kGood) << report.track.reason;
        } else {
            EXPECT_EQ(report.track.status, TrackStatus::kLost);
            EXPECT_NE(report.track.reason.find("usually"), std::string::npos)
                << report.track.reason;
            EXPECT_FALSE(report.fused);
        }
        Frame next = whole;
        next.stamp_s += 1.0 / 30;
        EXPECT_TRUE(pipeline.Process(next).fused);
    }
}

// A hand covers the camera for 0.7 s while the camera steps back from a wall by more than the
// truncation band. Neither the old velocity nor the covered frames help to find it again.
TEST(Pipeline, ACameraThatWasCoveredIsFoundWhereItHasMovedTo) {
    BoxRoom wall;
    wall.only_back_wall = true;
    for (const TrackingMethod method : {TrackingMethod::kSdf, TrackingMethod::kIcp}) {
        PipelineConfig config = SmallConfig();
        config.map.truncation_m = 0.05;
        config.trackers.method = method;
        Pipeline pipeline(config, SmallCamera());
        const auto process = [&](int i, double back_m, bool covered) {
            Frame frame = wall.Render(
                SmallCamera(), Eigen::Isometry3d(Eigen::Translation3d(0, 0, -back_m)), i / 30.0);
            if (covered) {
                std::ranges::fill(std::span(frame.depth_m.data(), frame.depth_m.size()), 0.4f);
                std::ranges::fill(std::span(frame.colour.data(), frame.colour.size()),
                                  Rgb8{90, 60, 50});
            }
            return pipeline.Process(frame);
        };
        for (int i = 0; i < 10; ++i) ASSERT_TRUE(process(i, 0, false).fused) << i;
        for (int i = 10; i < 30; ++i)
            EXPECT_EQ(process(i, 0, true).track.status, TrackStatus::kLost) << i;
        const FrameReport report = process(30, 0.15, false);
        EXPECT_TRUE(report.fused) << ToString(method) << ": " << report.track.reason;
        EXPECT_NEAR(report.track.T_world_camera.translation().z(), -0.15, 0.005)
            << ToString(method);
    }
}

// A pose that is not good enough for fusion does not constrain the next pose either. A good fit far
// from it does not count as a jump.
TEST(Pipeline, AfterAPoorPoseTheCameraMayBeAnywhere) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    BoxRoom room;
    room.has_ball = true;
    const auto process = [&](int i, double x_m) {
        return pipeline.Process(room.Render(
            SmallCamera(), Eigen::Isometry3d(Eigen::Translation3d(x_m, 0, 0)), i / 30.0));
    };
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(process(i, 0).fused) << i;
    ASSERT_EQ(process(10, 0.22).track.status, TrackStatus::kPoor);
    const FrameReport back = process(11, -0.12);  // 0.34 m in one frame
    EXPECT_TRUE(back.tracked()) << back.track.reason;
    for (int i = 12; i < 14; ++i) process(i, -0.12);
    const FrameReport report = process(14, -0.12);
    EXPECT_TRUE(report.fused) << report.track.reason;
    EXPECT_NEAR(report.track.T_world_camera.translation().x(), -0.12, 0.005);
}

// Each bad frame is lost with a reason and leaves the map unchanged. The next good frame is
// tracked.
TEST(Pipeline, BadFramesAreLostWithAReasonAndHarmNothing) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    for (int i = 0; i < 10; ++i) pipeline.Process(RoomFrame(i));
    const BlockId blocks = pipeline.map().size();
    const auto expect_lost = [&](Frame frame, const char* reason) {
        const FrameReport report = pipeline.Process(frame);
        EXPECT_EQ(report.track.status, TrackStatus::kLost);
        EXPECT_FALSE(report.fused);
        EXPECT_NE(report.track.reason.find(reason), std::string::npos) << report.track.reason;
        EXPECT_EQ(pipeline.map().size(), blocks);
    };
    Frame frame = RoomFrame(10);
    frame.depth_m = DepthImage(160, 120, 0.0f);
    expect_lost(frame, "0 depth pixels in the image");
    frame.depth_m = DepthImage(160, 120, 65.535f);
    expect_lost(frame, "depth_scale");
    FillDepth(frame, 7);
    expect_lost(frame, "noise");
    frame.depth_m = DepthImage(160, 120, std::numeric_limits<float>::quiet_NaN());
    expect_lost(frame, "0 depth pixels");
    EXPECT_EQ(pipeline.Process(RoomFrame(12)).track.status, TrackStatus::kGood);
}

TEST(Pipeline, NoiseDoesNotBecomeTheWorld) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    Frame noise = RoomFrame(0);
    FillDepth(noise, 3);
    EXPECT_FALSE(pipeline.Process(noise).fused);
    const FrameReport report = pipeline.Process(RoomFrame(1));
    EXPECT_TRUE(report.first);
    EXPECT_TRUE(report.fused);
    EXPECT_TRUE(report.track.T_world_camera.isApprox(Eigen::Isometry3d::Identity()));
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

TEST(Pipeline, AFrameWithoutColourIsTrackedByItsShape) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    for (int i = 0; i < 10; ++i) {
        Frame frame = RoomFrame(i);
        if (i % 3 == 1) frame.colour = {};
        ASSERT_EQ(pipeline.Process(frame).track.status, TrackStatus::kGood) << i;
    }
}

// For a third of a second the colour camera is covered, dazzled, or hangs.
TEST(Pipeline, WrongColoursNeitherMoveTheCameraNorPaintTheMap) {
    const auto mean_green = [](Pipeline& pipeline) {
        const TriangleMesh mesh = pipeline.mapping().Mesh();
        double sum = 0;
        for (const Rgb8& colour : mesh.colours) sum += colour.g;
        return sum / static_cast<double>(mesh.colours.size());
    };
    double usual = 0;
    for (const char* fault : {"none", "dark", "dazzled", "hangs"}) {
        SCOPED_TRACE(fault);
        Pipeline pipeline(SmallConfig(), SmallCamera());
        Frame before = RoomFrame(0);
        for (int i = 0; i < 30; ++i) {
            Frame frame = RoomFrame(i);
            const bool faulty = i >= 10 && i < 20 && fault != std::string("none");
            if (faulty && fault == std::string("hangs"))
                frame.colour = before.colour;
            else if (faulty)
                std::ranges::fill(
                    std::span(frame.colour.data(), frame.colour.size()),
                    fault == std::string("dark") ? Rgb8{3, 3, 3} : Rgb8{255, 255, 255});
            before = frame;
            const FrameReport report = pipeline.Process(frame);
            ASSERT_EQ(report.track.status, TrackStatus::kGood) << i << ": " << report.track.reason;
            EXPECT_TRUE(report.fused);
            EXPECT_EQ(report.track.colour_rejected, faulty) << i;
            const Eigen::Isometry3d truth = SmoothPath(0).inverse() * SmoothPath(i);
            EXPECT_LT((truth.inverse() * report.track.T_world_camera).translation().norm(), 0.006)
                << i;
        }
        if (fault == std::string("none")) usual = mean_green(pipeline);
        EXPECT_NEAR(mean_green(pipeline), usual, 2);
    }
}

// After a gap colours that do not fit may be those of another place: they are not called wrong.
TEST(Pipeline, AfterAGapColoursAreNotBlamed) {
    for (const double gap_s : {0.0, 0.8}) {
        Pipeline pipeline(SmallConfig(), SmallCamera());
        for (int i = 0; i < 10; ++i) pipeline.Process(RoomFrame(i));
        Frame dark = RoomFrame(10);
        dark.stamp_s += gap_s;
        std::ranges::fill(std::span(dark.colour.data(), dark.colour.size()), Rgb8{3, 3, 3});
        EXPECT_EQ(pipeline.Process(dark).track.colour_rejected, gap_s == 0);
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

TEST(MotionModel, ExpectsConstantVelocityAndForgetsItOverGaps) {
    MotionModel model({});
    EXPECT_TRUE(model.Predict(1.0).isApprox(Eigen::Isometry3d::Identity()));
    Vector6d step;
    step << 0.01, -0.02, 0.03, 0.1, 0.0, -0.1;
    const Eigen::Isometry3d T0 = SmoothPath(7);
    model.Add({0.0, T0}, {});
    EXPECT_TRUE(model.Predict(0.1).isApprox(T0));
    model.Add({0.1, T0 * Se3Exp(step)}, {});
    EXPECT_TRUE(model.Predict(0.2).isApprox(T0 * Se3Exp(2 * step), 1e-9));
    EXPECT_TRUE(model.Predict(0.15).isApprox(T0 * Se3Exp(1.5 * step), 1e-9));
    EXPECT_TRUE(model.Predict(5.0).isApprox(T0 * Se3Exp(step), 1e-9));  // too long ago
    EXPECT_EQ(model.SinceLast(5.0), 0);
}

TEST(MotionModel, MotionsThatNothingShowsComeToRest) {
    MotionModel::Config config;
    MotionModel model(config);
    Vector6d velocity;
    velocity << 0, 0, 0.1, 0.5, 0, 0;
    model.Add({0.0, Eigen::Isometry3d::Identity()}, {});
    model.Add({0.1, Se3Exp(0.1 * velocity)}, {});
    for (int i = 1; i <= 10; ++i) {
        const double stamp_s = 0.1 + 0.1 * i * config.come_to_rest_s;
        model.Add({stamp_s, model.Predict(stamp_s)}, {.degenerate = true});
    }
    const Vector6d left = Se3Log(model.last()->T_world_camera.inverse() *
                                 model.Predict(0.2 + config.come_to_rest_s)) /
                          0.1;
    EXPECT_LT((left - velocity * std::exp(-1.0)).norm(), 1e-3 * velocity.norm());
}

}  // namespace
}  // namespace tessera
