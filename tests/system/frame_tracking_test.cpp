// What the tracking half of a frame's life decides beyond a single pose.
#include "system/frame_tracking.h"

#include <gtest/gtest.h>

#include "system/room_frames.h"

namespace tessera {
namespace {

using testing_support::SmallCamera;

class FrameTrackingTest : public testing::Test {
  protected:
    FrameTrackingTest() {
        config_.pipeline = SmallConfig();
        config_.loops.enabled = true;
    }
    // The first frame of a world, which is tracked whatever it shows.
    void SeeFirst(FrameTracking& tracking) {
        tracking.Begin(RoomFrame(0));
        tracking.Track(RoomFrame(0), map_, tracked_);
        tracking.End(tracked_);
    }

    RunConfig config_;
    const BlockMap map_{SmallConfig().map};
    TrackedFrame tracked_;
};

// The map stays as it is, so a lost camera does not begin a new part of it either.
TEST_F(FrameTrackingTest, BeginsNoPartWhileNothingIsAddedToTheMap) {
    FrameTracking tracking(config_, SmallCamera(), nullptr, {});
    SeeFirst(tracking);
    tracked_.report.track.status = TrackStatus::kLost;
    for (const double stamp_s : {0.5, 1.5, 2.5}) {
        tracked_.report.stamp_s = stamp_s;
        tracking.End(tracked_);
    }
    tracking.stage().SetFusing(false);
    tracking.Begin(RoomFrame(90));
    EXPECT_TRUE(tracking.stage().last());
    tracking.stage().SetFusing(true);
    tracking.Begin(RoomFrame(90));
    EXPECT_FALSE(tracking.stage().last()) << "a part begins";
}

// It cannot be found by appearance: the gate guards it, as it does without loop closure.
TEST_F(FrameTrackingTest, AResumedCameraWithoutColourMustBeWhereTheScanEnded) {
    for (const bool colour : {false, true}) {
        Frame frame = RoomFrame(0);
        frame.stamp_s = 20;
        if (!colour) frame.colour = {};
        const Eigen::Isometry3d T_elsewhere(Eigen::Translation3d(3, 0, 0));
        FrameTracking tracking(config_, SmallCamera(), nullptr,
                               FramePlan({}, {{20, T_elsewhere}}, "poses"));
        TrackingResume resume;
        resume.last = StampedPose{3.5, Eigen::Isometry3d::Identity()};
        tracking.Resume(resume);
        tracking.Track(frame, map_, tracked_);
        EXPECT_EQ(tracked_.report.tracked(), colour);
    }
}

}  // namespace
}  // namespace tessera
