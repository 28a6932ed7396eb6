// Frames that show nothing, something false or, after a gap, another place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "support/box_room.h"
#include "system/pipeline.h"
#include "system/room_frames.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

void FillDepth(Frame& frame, std::uint32_t seed) {
    for (float& z : std::span(frame.depth_m.data(), frame.depth_m.size())) {
        seed = seed * 1664525u + 1013904223u;
        z = 0.3f + static_cast<float>(seed >> 8) * (4.0f / (1 << 24));
    }
}

// In this share of the view, strips lie before and behind the map in turn: no pose fits them.
void SpoilLeft(Frame& frame, int share) {
    for (int y = 0; y < frame.depth_m.height(); ++y)
        for (int x = 0; x < frame.depth_m.width() / share; ++x)
            frame.depth_m(x, y) += y / 8 % 2 == 0 ? 0.06f : -0.06f;
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
        SpoilLeft(frame, 2);
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
    const auto process = [&](int i, double x_m, bool changed = false) {
        Frame frame = room.Render(SmallCamera(), Eigen::Isometry3d(Eigen::Translation3d(x_m, 0, 0)),
                                  i / 30.0);
        if (changed) SpoilLeft(frame, 3);
        return pipeline.Process(frame);
    };
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(process(i, 0).fused) << i;
    ASSERT_EQ(process(10, 0.22, true).track.status, TrackStatus::kPoor);
    const FrameReport back = process(11, -0.12);  // 0.34 m in one frame
    EXPECT_TRUE(back.tracked()) << back.track.reason;
    for (int i = 12; i < 14; ++i) process(i, -0.12);
    const FrameReport report = process(14, -0.12);
    EXPECT_TRUE(report.fused) << report.track.reason;
    EXPECT_NEAR(report.track.T_world_camera.translation().x(), -0.12, 0.005);
}

// The camera comes back faster than its motion predicts. What is fused may lie far from its
// prediction, if it fits as well as usual and shows nothing new.
TEST(Pipeline, AFrameThatFitsIsRightWhereverItWasExpected) {
    for (const bool spoilt : {false, true}) {
        Pipeline pipeline(SmallConfig(), SmallCamera());
        BoxRoom room;
        room.has_ball = true;
        const auto frame_at = [&](int i, double x_m) {
            return room.Render(SmallCamera(), Eigen::Isometry3d(Eigen::Translation3d(x_m, 0, 0)),
                               i / 30.0);
        };
        for (int i = 0; i < 10; ++i)
            ASSERT_TRUE(pipeline.Process(frame_at(i, 0.03 * i)).fused) << i;
        Frame frame = frame_at(10, 0.05);
        if (spoilt) SpoilLeft(frame, 3);
        const FrameReport report = pipeline.Process(frame);
        EXPECT_EQ(report.fused, !spoilt) << report.track.reason;
        EXPECT_GT(report.track.innovation_m, 0.2);
        EXPECT_NEAR(report.track.T_world_camera.translation().x(), 0.05, 0.005);
        EXPECT_EQ(report.track.reason.find("predicted") != std::string::npos, spoilt);
    }
}

// At 5 Hz the camera moves by more than predictions are worth: half a fit is no evidence then.
TEST(Pipeline, WhereNothingCanBePredictedHalfAFitIsNoEvidence) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    BoxRoom room;
    room.has_ball = true;
    const auto frame_at = [&](int i) {
        const double way_m = i % 2 == 0 ? 0.04 : -0.04;
        return room.Render(SmallCamera(), Eigen::Isometry3d(Eigen::Translation3d(way_m, 0, 0)),
                           i / 5.0);
    };
    for (int i = 0; i < 15; ++i) ASSERT_TRUE(pipeline.Process(frame_at(i)).fused) << i;
    Frame frame = frame_at(15);
    SpoilLeft(frame, 2);
    const FrameReport report = pipeline.Process(frame);
    EXPECT_GT(report.track.inlier_fraction, 0.4);
    EXPECT_EQ(report.track.status, TrackStatus::kLost);
    EXPECT_TRUE(pipeline.Process(frame_at(16)).fused);
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

}  // namespace
}  // namespace tessera
