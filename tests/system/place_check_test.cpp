#include "system/place_check.h"

#include <gtest/gtest.h>

#include "system/lost_camera.h"

namespace tessera {
namespace {

const PinholeCamera kPlaceCamera{320, 240, 260, 260, 159.5, 119.5};

// A wall 2 m away that fills the view; moving by 1 m along it leaves less than half of the view.
PreparedFrame SeenWall() {
    PreparedFrame frame;
    frame.width = kPlaceCamera.width;
    frame.height = kPlaceCamera.height;
    frame.depth_m = DepthImage(frame.width, frame.height, 2.0f);
    return frame;
}

Eigen::Isometry3d AlongX(double x_m) { return Eigen::Isometry3d(Eigen::Translation3d(x_m, 0, 0)); }

TEST(PlaceCheck, AsksOnlyWhereMostOfTheViewIsNew) {
    PlaceCheck check(kPlaceCamera);
    EXPECT_FALSE(check.open());
    EXPECT_FALSE(check.Due(AlongX(5)));
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(0), false));
    EXPECT_TRUE(check.open());
    EXPECT_FALSE(check.Due(AlongX(1.0)));
    EXPECT_TRUE(check.Due(AlongX(1.5)));  // the view is 2.46 m wide
    check.Remember(SeenWall(), AlongX(1.5));
    EXPECT_FALSE(check.Due(AlongX(1.5)));
    check.Move(AlongX(10));  // the map was corrected
    EXPECT_FALSE(check.Due(AlongX(11.5)));
    EXPECT_TRUE(check.Due(AlongX(1.5)));
}

TEST(PlaceCheck, ASecondViewThereConfirms) {
    PlaceCheck check(kPlaceCamera);
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(0), false));
    check.Remember(SeenWall(), AlongX(1.5));
    EXPECT_TRUE(check.Answer(FoundCamera{AlongX(1.55)}));
    EXPECT_FALSE(check.open());
}

TEST(PlaceCheck, AnotherViewFoundWithinReachConfirms) {
    PlaceCheck check(kPlaceCamera);
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(0), true)) << "it is the first";
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(0.1), true)) << "the same view";
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(9), false)) << "elsewhere";
    EXPECT_TRUE(check.open());
    EXPECT_TRUE(check.Begin(SeenWall(), AlongX(10.5), true));
    EXPECT_FALSE(check.open());
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(12), true)) << "a new place, nothing to confirm";
    check.Close();
    EXPECT_FALSE(check.open());
}

TEST(PlaceCheck, ViewsThatLeaveAMotionOpenConfirmButDoNotRefute) {
    PlaceCheck check(kPlaceCamera);
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(0), false));
    for (int i = 0; i < 5; ++i) {
        check.Remember(SeenWall(), AlongX(1.5), true);
        EXPECT_TRUE(
            check.Answer(i % 2 == 0 ? std::nullopt : std::optional(FoundCamera{AlongX(9)})));
        EXPECT_TRUE(check.open());
    }
    check.Remember(SeenWall(), AlongX(1.5), true);
    EXPECT_TRUE(check.Answer(FoundCamera{AlongX(1.5)}));
    EXPECT_FALSE(check.open());
}

TEST(PlaceCheck, ThreeViewsElsewhereOrNowhereRefute) {
    PlaceCheck check(kPlaceCamera);
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(0), false));
    check.Remember(SeenWall(), AlongX(1.5));
    EXPECT_TRUE(check.Answer(std::nullopt));
    EXPECT_TRUE(check.open());
    check.Remember(SeenWall(), AlongX(3));
    EXPECT_TRUE(check.Answer(FoundCamera{AlongX(3.2)}));
    check.Remember(SeenWall(), AlongX(4.5));
    EXPECT_FALSE(check.Answer(std::nullopt));
    EXPECT_FALSE(check.open());
    EXPECT_FALSE(check.Begin(SeenWall(), AlongX(9), false));  // found again: counts anew
    check.Remember(SeenWall(), AlongX(10.5));
    EXPECT_TRUE(check.Answer(std::nullopt));
}

TrackedFrame TrackedAt(double stamp_s, bool degenerate = false) {
    TrackedFrame tracked;
    tracked.report.stamp_s = stamp_s;
    tracked.report.track.status = TrackStatus::kGood;
    tracked.report.track.inlier_fraction = tracked.report.track.known_fraction = 0.9;
    tracked.report.track.degenerate = degenerate;
    tracked.prepared.has_colour = true;
    return tracked;
}

using Verdict = LostCamera::Verdict;

// Another recording may begin at an earlier time.
TEST(LostCamera, AfterAPauseItIsLostWhicheverWayTheClockGoes) {
    for (const double stamp_s : {90.0, 110.0}) {
        LostCamera camera(LoopConfig{}, 0.5);
        camera.Resume(100);
        EXPECT_EQ(camera.Judge(TrackedAt(stamp_s)), Verdict::kLost) << stamp_s;
        EXPECT_TRUE(camera.lost());
    }
    LostCamera camera(LoopConfig{}, 0.5);
    camera.Resume(100);
    EXPECT_EQ(camera.Judge(TrackedAt(100.1)), Verdict::kTracking);
}

// Soon after a loss there is no other place that this one could be mistaken for.
TEST(LostCamera, CanReachWhatIsNearAndSoon) {
    LostCamera camera(LoopConfig{}, 0.5);
    EXPECT_FALSE(camera.CanReach({100, AlongX(0)}));  // was never anywhere
    TrackedFrame before = TrackedAt(100);
    before.report.track.T_world_camera = AlongX(3);
    before.report.first = true;
    ASSERT_EQ(camera.Judge(before), Verdict::kTracking);
    EXPECT_TRUE(camera.CanReach({100.6, AlongX(3.7)}));
    EXPECT_FALSE(camera.CanReach({100.6, AlongX(4.1)}));  // faster than one walks
    EXPECT_FALSE(camera.CanReach({103, AlongX(3)}));      // too long ago
    camera.Move(AlongX(10));
    EXPECT_TRUE(camera.CanReach({100.6, AlongX(13.7)}));
    camera.SetLastGood({101.5, AlongX(14)});
    EXPECT_TRUE(camera.CanReach({103, AlongX(15)}));
    camera.SetLastGood({100, AlongX(13)});
    // A frame of the lost camera says nothing.
    TrackedFrame lost = TrackedAt(101);
    lost.report.track.status = TrackStatus::kLost;
    lost.report.track.T_world_camera = AlongX(50);
    EXPECT_EQ(camera.Judge(lost), Verdict::kLost);
    EXPECT_FALSE(camera.CanReach({101, AlongX(50)}));
    camera.Lose();
    EXPECT_FALSE(camera.CanReach({100.6, AlongX(13)}));
}

// After a time without depth a view that fits, but is known only in part, is enough where the
// camera can have got to. Elsewhere, or later, it may be another place.
TEST(LostCamera, APartOfAViewIsEnoughWithinReach) {
    const auto verdict = [](double stamp_s, double x_m) {
        LostCamera camera(LoopConfig{}, 0.5);
        TrackedFrame before = TrackedAt(100);
        before.report.first = true;
        EXPECT_EQ(camera.Judge(before), Verdict::kTracking);
        TrackedFrame blind = TrackedAt(100.1);
        blind.report.track.status = TrackStatus::kLost;
        EXPECT_EQ(camera.Judge(blind), Verdict::kLost);
        TrackedFrame after = TrackedAt(stamp_s);
        after.report.track.known_fraction = 0.5;
        after.report.track.T_world_camera = AlongX(x_m);
        return camera.Judge(after);
    };
    EXPECT_EQ(verdict(100.7, 0.6), Verdict::kFoundAgain);
    EXPECT_EQ(verdict(100.7, 1.3), Verdict::kLost);  // farther than one walks
    EXPECT_EQ(verdict(102.1, 0.6), Verdict::kLost);  // too long ago
}

TEST(LostCamera, WhereTheViewLeavesAMotionOpenARelocalisedPoseIsNotTrusted) {
    LostCamera camera(LoopConfig{}, 0.5);
    camera.Resume(100);
    EXPECT_EQ(camera.Judge(TrackedAt(110)), Verdict::kLost);
    camera.SetRelocalised(110.1);
    EXPECT_EQ(camera.Judge(TrackedAt(110.2, true)), Verdict::kLost);
    EXPECT_TRUE(camera.relocalised());
    EXPECT_EQ(camera.Judge(TrackedAt(110.3)), Verdict::kFoundAgain);
    EXPECT_FALSE(camera.relocalised());
    camera.Lose();
    EXPECT_EQ(camera.Judge(TrackedAt(110.4)), Verdict::kLost);
}

// Frames of 2 cm, of which seven are more than 5 cm. The doubt lasts for half a second.
TEST(LostCamera, AfterViewsThatLeaveAMotionOpenItsPlaceIsDoubted) {
    double stamp_s = 0;
    const auto see = [&stamp_s](LostCamera& camera, int frames, bool degenerate) {
        Verdict verdict = Verdict::kTracking;
        for (int i = 0; i < frames; ++i) {
            TrackedFrame tracked = TrackedAt(stamp_s += 0.03, degenerate);
            tracked.report.track.uncertainty_m = degenerate ? 1.0 : 0.002;
            verdict = camera.Judge(tracked);
        }
        return verdict;
    };
    LostCamera camera(LoopConfig{}, 0.5);
    see(camera, 6, true);
    EXPECT_EQ(see(camera, 1, false), Verdict::kTracking);
    see(camera, 6, true);  // six more: the good one began anew
    EXPECT_EQ(see(camera, 1, false), Verdict::kTracking);
    EXPECT_EQ(see(camera, 7, true), Verdict::kTracking);  // not yet: nothing would confirm a place
    EXPECT_EQ(see(camera, 1, false), Verdict::kDoubtful);
    EXPECT_EQ(see(camera, 15, false), Verdict::kDoubtful);
    EXPECT_EQ(see(camera, 2, false), Verdict::kTracking);
    see(camera, 7, true);
    EXPECT_EQ(see(camera, 1, false), Verdict::kDoubtful);
    camera.Confirm();
    EXPECT_EQ(see(camera, 1, false), Verdict::kTracking);
}

// A frame of a camera at x, this many frames after the beginning.
TrackedFrame FrameAt(int frame, double x_m, TrackStatus status) {
    TrackedFrame tracked;
    tracked.prepared.has_colour = true;
    tracked.report.stamp_s = frame / 30.0;
    tracked.report.first = frame == 0;
    TrackResult& track = tracked.report.track;
    track.T_world_camera = AlongX(x_m);
    track.status = status;
    track.known_fraction = track.inlier_fraction = 0.9;
    return tracked;
}

TEST(PoorlyTrackedCamera, IsLookedForAfterAWhile) {
    LostCamera camera(LoopConfig{}, 0.5);
    EXPECT_EQ(camera.Judge(FrameAt(0, 0, TrackStatus::kGood)), LostCamera::Verdict::kTracking);
    for (int i = 1; i < 40; ++i)
        EXPECT_EQ(camera.Judge(FrameAt(i, 0, TrackStatus::kPoor)),
                  i <= 16 ? LostCamera::Verdict::kTracking : LostCamera::Verdict::kDoubtful)
            << i;
    EXPECT_EQ(camera.Judge(FrameAt(40, 0, TrackStatus::kGood)), LostCamera::Verdict::kTracking);
    EXPECT_EQ(camera.Judge(FrameAt(41, 0, TrackStatus::kPoor)), LostCamera::Verdict::kTracking);
    camera.Doubt();
    EXPECT_TRUE(camera.lost());
}

// Where the motion model expects a camera that was at a wrong pose says nothing: it fits, and it
// can have got there.
TEST(ALostCamera, IsFoundByItsFitWhereItCanHaveGot) {
    LostCamera camera(LoopConfig{}, 0.5);
    camera.Judge(FrameAt(0, 0, TrackStatus::kGood));
    EXPECT_EQ(camera.Judge(FrameAt(1, 0, TrackStatus::kLost)), LostCamera::Verdict::kLost);
    EXPECT_EQ(camera.Judge(FrameAt(30, 1.5, TrackStatus::kPoor)), LostCamera::Verdict::kLost);
    TrackedFrame in_part = FrameAt(31, 1.1, TrackStatus::kPoor);
    in_part.report.track.inlier_fraction = 0.8;  // as at a wrong place
    EXPECT_EQ(camera.Judge(in_part), LostCamera::Verdict::kLost);
    EXPECT_EQ(camera.Judge(FrameAt(31, 1.1, TrackStatus::kPoor)), LostCamera::Verdict::kFoundAgain);
    camera.Judge(FrameAt(32, 1.1, TrackStatus::kGood));
    EXPECT_EQ(camera.Judge(FrameAt(33, 1.1, TrackStatus::kLost)), LostCamera::Verdict::kLost);
    EXPECT_EQ(camera.Judge(FrameAt(33 + 61, 1.1, TrackStatus::kGood)), LostCamera::Verdict::kLost);
}

}  // namespace
}  // namespace tessera
