// The search for a lost camera, frame by frame, without tracker or map.
#include "system/camera_search.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

using Question = CameraSearch::Question;

const PinholeCamera kSearchCamera{320, 240, 260, 260, 159.5, 119.5};

Eigen::Isometry3d At(double x_m) { return Eigen::Isometry3d(Eigen::Translation3d(x_m, 0, 0)); }

class CameraSearchTest : public testing::Test {
  protected:
    // A frame that fits at this place, where the view is a wall of 2.46 m.
    TrackedFrame& See(double stamp_s, double x_m, TrackStatus status = TrackStatus::kGood) {
        frame_ = {};
        frame_.prepared.has_colour = true;
        frame_.prepared.width = kSearchCamera.width;
        frame_.prepared.height = kSearchCamera.height;
        frame_.prepared.depth_m = DepthImage(frame_.prepared.width, frame_.prepared.height, 2.0f);
        frame_.prepared.valid_depth_pixels = frame_.prepared.width * frame_.prepared.height;
        frame_.to_fuse = status == TrackStatus::kGood;
        frame_.report.stamp_s = stamp_s;
        TrackResult& track = frame_.report.track;
        track.T_world_camera = At(x_m);
        track.status = status;
        track.inlier_fraction = track.known_fraction = 0.9;
        track.distance_rms_m = 0.005;
        return frame_;
    }
    TrackedFrame& SeeFirst(double stamp_s, double x_m) {
        See(stamp_s, x_m).report.first = true;
        return frame_;
    }
    // Tracked at 0, then lost at 1 s.
    void LoseIt() {
        search_.AfterTracking(SeeFirst(0, 0), true);
        const auto step = search_.AfterTracking(See(1, 0, TrackStatus::kLost), true);
        EXPECT_TRUE(step.lost);
        EXPECT_EQ(step.question, Question::kWhere);
    }
    std::optional<int> Told() {
        search_.TellWhereFound(frame_);
        return frame_.found_at;
    }

    CameraSearch search_{LoopConfig{}, 0.5, kSearchCamera};
    TrackedFrame frame_;
};

TEST_F(CameraSearchTest, ATrackedCameraIsNotLookedFor) {
    for (int i = 0; i < 50; ++i) {
        const auto step =
            search_.AfterTracking(i == 0 ? SeeFirst(0, 0) : See(0.03 * i, 0.01 * i), true);
        EXPECT_FALSE(step.lost);
        EXPECT_EQ(step.question, Question::kNone);
        EXPECT_TRUE(frame_.to_fuse);
        EXPECT_FALSE(Told());
    }
}

TEST_F(CameraSearchTest, ALostOneIsAskedForOnceAtATime) {
    LoseIt();
    const auto step = search_.AfterTracking(See(1.1, 0, TrackStatus::kLost), false);
    EXPECT_TRUE(step.lost);
    EXPECT_EQ(step.question, Question::kNone);
    See(1.2, 0, TrackStatus::kLost).prepared.valid_depth_pixels = 0;
    EXPECT_EQ(search_.AfterTracking(frame_, true).question, Question::kNone);
}

// A scan that ended while the camera was lost is resumed.
TEST_F(CameraSearchTest, OneThatWasLostWhenTheScanEndedIsNotKnownByTheNextFrame) {
    for (const bool lost : {false, true}) {
        CameraSearch search{LoopConfig{}, 0.5, kSearchCamera};
        search.Resume(100, lost);
        See(100.1, 0).report.track.inlier_fraction = 0.4;
        EXPECT_EQ(search.AfterTracking(frame_, true).lost, lost);
        EXPECT_FALSE(search.AfterTracking(See(100.2, 0), true).lost);
    }
}

// A single frame without colour does not make it one that can be found by its depth alone.
TEST_F(CameraSearchTest, LostForLongItIsFoundByItsFitOnlyIfItNeverShowsColours) {
    for (const bool colour : {false, true}) {
        CameraSearch search{LoopConfig{}, 0.5, kSearchCamera};
        SeeFirst(100, 0).prepared.has_colour = colour;
        EXPECT_FALSE(search.AfterTracking(frame_, true).lost);
        See(101, 0, TrackStatus::kLost).prepared.has_colour = colour;
        EXPECT_TRUE(search.AfterTracking(frame_, true).lost);
        See(110, 9).prepared.has_colour = false;
        EXPECT_EQ(search.AfterTracking(frame_, true).lost, colour);
    }
}

// Live: the answer comes between two frames.
TEST_F(CameraSearchTest, WhereItCannotHaveGotToASecondViewDecides) {
    LoseIt();
    EXPECT_FALSE(search_.TakeWhere(std::nullopt, 1.2));
    const auto found = search_.TakeWhere(FoundCamera{At(9), 4}, 1.3);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->translation().x(), 9);
    const auto landed = search_.AfterTracking(See(1.3, 9), true);
    EXPECT_FALSE(landed.lost);
    EXPECT_STREQ(landed.note, kPlaceUnconfirmed);
    EXPECT_EQ(landed.question, Question::kNone) << "it is the first view";
    EXPECT_FALSE(frame_.to_fuse);
    EXPECT_EQ(Told(), 4);

    EXPECT_EQ(search_.AfterTracking(See(1.4, 9.1), true).question, Question::kNone);
    EXPECT_FALSE(frame_.to_fuse);
    EXPECT_FALSE(Told());
    EXPECT_EQ(search_.AfterTracking(See(2, 10.5), false).question, Question::kNone);
    EXPECT_EQ(search_.AfterTracking(See(2.1, 10.5), true).question, Question::kSecondView);
    const char* note = "";
    EXPECT_TRUE(search_.TakeSecondView(FoundCamera{At(10.52), 7}, note));
    EXPECT_STREQ(note, kPlaceConfirmed);
    EXPECT_EQ(search_.AfterTracking(See(2.2, 10.5), true).question, Question::kNone);
    EXPECT_TRUE(frame_.to_fuse);
    EXPECT_EQ(Told(), 7);
}

TEST_F(CameraSearchTest, WithinReachItIsFusedAtOnce) {
    LoseIt();
    ASSERT_TRUE(search_.TakeWhere(FoundCamera{At(0.3), 4}, 1.3));
    EXPECT_STREQ(search_.AfterTracking(See(1.3, 0.3), true).note, "");
    EXPECT_TRUE(frame_.to_fuse);
    EXPECT_EQ(Told(), 4);
}

TEST_F(CameraSearchTest, ARefutedPlaceLosesItAgain) {
    LoseIt();
    search_.AfterTracking(See(1.3, 9, TrackStatus::kLost), true);
    EXPECT_STREQ(search_.Land(FoundCamera{At(9), 4}, See(1.3, 9)), kPlaceUnconfirmed);
    const char* note = "";
    for (int i = 0; i < 3; ++i) {
        const double x_m = 10.5 + 1.5 * i;
        ASSERT_EQ(search_.AfterTracking(See(2 + i, x_m), true).question, Question::kSecondView);
        EXPECT_EQ(search_.TakeSecondView(std::nullopt, note), i < 2);
    }
    EXPECT_STREQ(note, kPlaceRefuted);
    EXPECT_TRUE(search_.AfterTracking(See(5, 13.5), true).lost);
}

// In lockstep the answer comes in the same frame.
TEST_F(CameraSearchTest, LandingIsToldWithItsFrame) {
    LoseIt();
    EXPECT_FALSE(Told());
    EXPECT_STREQ(search_.Land(FoundCamera{At(0.3), 4}, See(1.1, 0.3)), "");
    EXPECT_EQ(Told(), 4);
    EXPECT_FALSE(search_.AfterTracking(See(1.2, 0.3), true).lost);
    EXPECT_FALSE(Told());
}

// It was found by appearance but not tracked there; then a new part of the scan begins.
TEST_F(CameraSearchTest, ANewPartOwesNothingToAPlaceThatWasNeverReached) {
    LoseIt();
    ASSERT_TRUE(search_.TakeWhere(FoundCamera{At(9), 4}, 1.3));
    EXPECT_TRUE(search_.AfterTracking(See(1.3, 9, TrackStatus::kLost), true).lost);
    EXPECT_FALSE(Told());
    const auto step = search_.AfterTracking(SeeFirst(4, 1000), true);
    EXPECT_FALSE(step.lost);
    EXPECT_STREQ(step.note, "");
    EXPECT_TRUE(frame_.to_fuse);
    EXPECT_FALSE(Told());
    search_.AfterTracking(See(4.1, 1000), true);
    EXPECT_TRUE(frame_.to_fuse);
}

// Loops were switched off after the camera was found: nothing is judged, but it has moved there.
TEST_F(CameraSearchTest, WhereItWasFoundIsToldEvenIfNothingIsJudged) {
    LoseIt();
    ASSERT_TRUE(search_.TakeWhere(FoundCamera{At(9), 4}, 1.3));
    See(1.3, 9);
    EXPECT_EQ(Told(), 4);
}

// A second view has just confirmed the place; before the next frame is tracked, a new part begins.
TEST_F(CameraSearchTest, NorToAPlaceThatItHasLeft) {
    LoseIt();
    search_.Land(FoundCamera{At(9), 4}, See(1.1, 9));
    EXPECT_EQ(Told(), 4);
    ASSERT_EQ(search_.AfterTracking(See(1.2, 10.5), true).question, Question::kSecondView);
    const char* note = "";
    ASSERT_TRUE(search_.TakeSecondView(FoundCamera{At(10.5), 7}, note));
    search_.AfterTracking(See(1.3, 10.5, TrackStatus::kLost), true);
    EXPECT_FALSE(Told());
    search_.AfterTracking(SeeFirst(4, 1000), true);
    EXPECT_FALSE(Told());
}

// Its frames were poor for long, or left a motion open.
TEST_F(CameraSearchTest, OneInDoubtIsConfirmedOrMoved) {
    const auto doubt = [this](CameraSearch& search) {
        search.AfterTracking(SeeFirst(0, 0), true);
        CameraSearch::Step step;
        for (int i = 1; i < 30; ++i)
            step = search.AfterTracking(See(0.03 * i, 0, TrackStatus::kPoor), true);
        return step;
    };
    const auto step = doubt(search_);
    EXPECT_FALSE(step.lost);
    EXPECT_EQ(step.question, Question::kWhere);
    EXPECT_FALSE(search_.TakeWhere(FoundCamera{At(0.05), 4}, 0.9)) << "it is there";
    EXPECT_FALSE(search_.AfterTracking(See(0.93, 0), true).lost);
    EXPECT_TRUE(frame_.to_fuse);

    CameraSearch other{LoopConfig{}, 0.5, kSearchCamera};
    doubt(other);
    EXPECT_TRUE(other.TakeWhere(FoundCamera{At(0.4), 4}, 0.9));
    See(0.93, 0.4).report.track.inlier_fraction = 0.3;
    EXPECT_TRUE(other.AfterTracking(frame_, true).lost) << "must fit there";

    CameraSearch here{LoopConfig{}, 0.5, kSearchCamera};
    doubt(here);
    EXPECT_FALSE(here.Confirms(FoundCamera{At(0.05), 4}, frame_)) << "it is tracked poorly";
    EXPECT_TRUE(here.Confirms(FoundCamera{At(0.05), 4}, See(0.93, 0)));
    EXPECT_FALSE(here.Confirms(FoundCamera{At(0.4), 4}, frame_));
}

TEST_F(CameraSearchTest, WhenTheMapMovesAllPlacesMove) {
    LoseIt();
    search_.Move(At(100));
    EXPECT_STREQ(search_.Land(FoundCamera{At(100.3), 4}, See(1.1, 100.3)), "") << "within reach";
    search_.AfterTracking(See(1.2, 100.3, TrackStatus::kLost), true);
    EXPECT_STREQ(search_.Land(FoundCamera{At(9), 4}, See(1.3, 9)), kPlaceUnconfirmed);
    search_.Move(At(20));
    EXPECT_EQ(search_.AfterTracking(See(1.4, 29.1), true).question, Question::kNone);
    EXPECT_EQ(search_.AfterTracking(See(1.5, 30.5), true).question, Question::kSecondView);
}

}  // namespace
}  // namespace tessera
