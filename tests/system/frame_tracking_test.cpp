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

}  // namespace
}  // namespace tessera
