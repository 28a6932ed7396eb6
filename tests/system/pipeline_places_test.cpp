// Frames whose place is not known: after a gap or a loss, far from their prediction, and where no
// pose can be predicted.
#include <gtest/gtest.h>

#include <string>

#include "support/box_room.h"
#include "system/pipeline.h"
#include "system/room_frames.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;

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
// A frame that shows what is new to the map confirms no pose. Where poses can be predicted such a
// pose is poor.
TEST(Pipeline, WhereNothingCanBePredictedAFarPoseIsConfirmedOrLost) {
    for (const bool shows_new : {false, true}) {
        Pipeline pipeline(SmallConfig(), SmallCamera());
        BoxRoom room;
        room.has_ball = true;
        const auto frame_at = [&](int i, double way_m, int columns) {
            Frame frame = room.Render(
                SmallCamera(), Eigen::Isometry3d(Eigen::Translation3d(way_m, 0, 0)), i / 5.0);
            for (int y = 0; y < frame.depth_m.height(); ++y)
                for (int x = columns; x < frame.depth_m.width(); ++x) frame.depth_m(x, y) = 0;
            return frame;
        };
        for (int i = 0; i < 15; ++i)
            ASSERT_TRUE(pipeline.Process(frame_at(i, i % 2 == 0 ? 0.04 : -0.04, 100)).fused) << i;
        const FrameReport report = pipeline.Process(frame_at(15, -0.12, shows_new ? 160 : 80));
        EXPECT_GT(report.track.innovation_m, 0.2);
        EXPECT_GT(report.track.inlier_fraction, 0.9);
        EXPECT_EQ(report.track.status, shows_new ? TrackStatus::kLost : TrackStatus::kGood)
            << report.track.reason;
    }
}

// At the start of a part it is not known again whether poses can be predicted: then only a quarter
// of a second speaks for it.
TEST(Pipeline, ANewPartForgetsThatPosesWerePredicted) {
    for (const bool part : {false, true}) {
        Pipeline pipeline(SmallConfig(), SmallCamera());
        BoxRoom room;
        room.has_ball = true;
        const Eigen::Isometry3d T_room_camera = Eigen::Isometry3d::Identity();
        for (int i = 0; i < 10; ++i)
            ASSERT_TRUE(pipeline.Process(room.Render(SmallCamera(), T_room_camera, 0.3 * i)).fused);
        if (part) pipeline.tracking().BeginPart(Eigen::Isometry3d(Eigen::Translation3d(9, 0, 0)));
        const FrameReport first =
            pipeline.Process(room.Render(SmallCamera(), T_room_camera, 0.3 * 10));
        ASSERT_TRUE(first.fused);
        EXPECT_NEAR(first.track.T_world_camera.translation().x(), part ? 9 : 0, 1e-3);
        Frame frame = room.Render(SmallCamera(), T_room_camera, 0.3 * 11);
        SpoilLeft(frame, 2);
        EXPECT_EQ(pipeline.Process(frame).track.status,
                  part ? TrackStatus::kLost : TrackStatus::kGood);
    }
}

// Before a bare wall the camera backs away at once. What the wall leaves open could only follow the
// prediction, which is far off: poor, or after a gap in time, when there is none, lost.
TEST(Pipeline, AFarPoseThatLeavesAMotionOpenIsWorthNothingAfterAGap) {
    for (const bool gap : {false, true}) {
        Pipeline pipeline(SmallConfig(), SmallCamera());
        BoxRoom wall;
        wall.only_back_wall = true;
        wall.texture = 0;
        const auto frame_at = [&](int i, double z_m) {
            return wall.Render(SmallCamera(), Eigen::Isometry3d(Eigen::Translation3d(0, 0, z_m)),
                               i / 30.0);
        };
        for (int i = 0; i < 10; ++i) ASSERT_TRUE(pipeline.Process(frame_at(i, 0.03 * i)).fused);
        const FrameReport report = pipeline.Process(frame_at(gap ? 40 : 10, 0.03));
        EXPECT_TRUE(report.track.degenerate);
        EXPECT_GT(report.track.innovation_m, 0.2);
        EXPECT_EQ(report.track.status, gap ? TrackStatus::kLost : TrackStatus::kPoor)
            << report.track.reason;
    }
}

}  // namespace
}  // namespace tessera
