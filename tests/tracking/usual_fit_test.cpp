#include "tracking/usual_fit.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TrackResult Fit(double inliers, double known = 0.9, double distance_rms_m = 0.01) {
    TrackResult track;
    track.inlier_fraction = inliers;
    track.known_fraction = known;
    track.distance_rms_m = distance_rms_m;
    return track;
}

TEST(UsualFit, AFrameMayFitALittleWorse) {
    UsualFit usual(0.15, 0.35);
    for (int i = 0; i < 5; ++i) usual.Add(Fit(0.8));
    EXPECT_TRUE(usual.Matches(Fit(0.69, 0.9, 0.02)));
    EXPECT_FALSE(usual.Matches(Fit(0.67, 0.9, 0.02)));
    EXPECT_NE(usual.Reason(Fit(0.67)).find("67 % of the depth fits the map, usually 80 %"),
              std::string::npos)
        << usual.Reason(Fit(0.67));
    EXPECT_TRUE(usual.Matches(Fit(1, 0.36)));
    EXPECT_FALSE(usual.Matches(Fit(1, 0.34)));
    EXPECT_NE(usual.Reason(Fit(1, 0.34)).find("34 % of the depth lies in the map"),
              std::string::npos);
}

// Before anything is known, 95 % are usual.
TEST(UsualFit, TheFirstFramesMustFitToo) {
    UsualFit usual(0.1, 0.35);
    for (int k = 0; k < 2; ++k) {
        EXPECT_TRUE(usual.Matches(Fit(0.86)));
        EXPECT_FALSE(usual.Matches(Fit(0.85)));
        EXPECT_FALSE(usual.Matches(Fit(1, 0.34)));
        usual.Add(Fit(0.5));
        EXPECT_TRUE(usual.Matches(Fit(0.5)));
        usual.Clear();
    }
}

// Whether the next pose can be predicted is learnt from how far poses were from their predictions.
// Otherwise a wrong pose of the second frame would speak against all right ones that follow.
TEST(UsualFit, AFrameThatLeavesAMotionOpenIsNoFirstEvidenceAgainstPredictions) {
    UsualFit usual(0.1, 0.35);
    TrackResult open = Fit(0.95), held = open;
    open.innovation_share = held.innovation_share = 0.6;
    open.degenerate = true;
    usual.Add(open);
    EXPECT_TRUE(usual.Predicted(0.1));
    usual.Add(held);
    EXPECT_FALSE(usual.Predicted(0.1));
    usual.ForgetPredictions();
    held.innovation_share = 0.45;
    usual.Add(held);
    EXPECT_TRUE(usual.Predicted(0.1));
    for (int i = 0; i < 10; ++i) usual.Add(open);  // beside others it counts
    EXPECT_FALSE(usual.Predicted(0.1));
}

TEST(UsualFit, KnowsWhetherPosesArePredicted) {
    UsualFit usual(0.1, 0.35);
    EXPECT_TRUE(usual.Predicted(0.24));  // at first a matter of time only
    EXPECT_FALSE(usual.Predicted(0.26));
    TrackResult track = Fit(0.95);
    track.innovation_share = 0.45;
    usual.Add(track);
    EXPECT_TRUE(usual.Predicted(0.4));
    track.innovation_share = 1;
    usual.Add(track);
    EXPECT_FALSE(usual.Predicted(0.03));
    track.innovation_share = 0.1;
    for (int i = 0; i < 9; ++i) usual.Add(track);
    EXPECT_TRUE(usual.Predicted(0.03));
    EXPECT_TRUE(usual.Predicted(0.4));
    usual.ForgetPredictions();
    EXPECT_FALSE(usual.Predicted(0.26));
    EXPECT_FALSE(usual.Matches(Fit(0.85, 0.9, 0.02)));  // how well frames fit is not forgotten
}

// A single frame hardly changes what is usual; half a second does.
TEST(UsualFit, FollowsTheScene) {
    UsualFit usual(0.15, 0.35);
    for (int i = 0; i < 5; ++i) usual.Add(Fit(0.95));
    const TrackResult worse = Fit(0.6, 0.9, 0.02);
    usual.Add(worse);
    EXPECT_FALSE(usual.Matches(worse));
    for (int i = 0; i < 15; ++i) usual.Add(worse);
    EXPECT_TRUE(usual.Matches(worse));
}

// Something was put down in view meanwhile: it does not fit, and all else fits as well as before.
TEST(UsualFit, WhatHasChangedIsNoMisfit) {
    UsualFit usual(0.15, 0.35);
    for (int i = 0; i < 5; ++i) usual.Add(Fit(0.95, 0.9, 0.006));
    EXPECT_TRUE(usual.Matches(Fit(0.6, 0.9, 0.0074)));
    EXPECT_FALSE(usual.Matches(Fit(0.6, 0.9, 0.0076)));
    EXPECT_FALSE(usual.Matches(Fit(0.6, 0.3, 0.006)));
}

TEST(UsualFit, CanBeSwitchedOff) {
    UsualFit usual(1, 0.35);
    usual.Add(Fit(0.95));
    EXPECT_TRUE(usual.Matches(Fit(0.01, 0.01)));
    EXPECT_FALSE(usual.Confirms(Fit(1)));  // of a pose far from its prediction
}

// It must also lie in the map.
TEST(UsualFit, ConfirmsWhatShowsNothingNew) {
    UsualFit usual(0.1, 0.35);
    for (int i = 0; i < 5; ++i) usual.Add(Fit(0.9, 0.95));
    EXPECT_TRUE(usual.Confirms(Fit(0.9, 0.91)));
    EXPECT_FALSE(usual.Confirms(Fit(0.9, 0.89)));
    EXPECT_TRUE(usual.Matches(Fit(0.9, 0.89)));
    EXPECT_FALSE(usual.Confirms(Fit(0.8, 1)));
}

}  // namespace
}  // namespace tessera
