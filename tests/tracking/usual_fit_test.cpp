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
    EXPECT_TRUE(usual.Matches(Fit(0.2, 0.1)));  // nothing is known yet
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
    usual.Clear();
    EXPECT_TRUE(usual.Matches(Fit(0.2, 0.1)));
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
}

}  // namespace
}  // namespace tessera
