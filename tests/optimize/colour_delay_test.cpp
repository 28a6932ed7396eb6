#include "optimize/colour_delay.h"

#include <gtest/gtest.h>

#include "optimize/squares_view.h"

namespace tessera {
namespace {

// Colour's stamps say `stamped_s` of the delay. The camera moves at `speed` times its usual one.
ColourDelayEstimator Seen(double delay_s, double readout_s = 0, double stamped_s = 0,
                          double speed = 1, int views = 40) {
    ColourDelayEstimator estimator(squares_view::kCamera);
    for (int i = 0; i < views; ++i) {
        Frame frame = squares_view::View(0.1 * i * speed, delay_s * speed, readout_s * speed);
        frame.stamp_s = 0.1 * i;
        frame.colour_stamp_s = frame.stamp_s + stamped_s;
        estimator.Add(frame, MakeEdgeView(frame));
    }
    return estimator;
}

TEST(ColourDelay, IsFound) {
    for (const double delay_s : {-0.011, 0.0, 0.007, 0.02}) {
        const auto found = Seen(delay_s).Estimate({});
        ASSERT_TRUE(found) << delay_s;
        EXPECT_NEAR(found->delay_s, delay_s, 0.001);
        EXPECT_NEAR(found->readout_s, 0, 0.003);
        EXPECT_EQ(found->shown(), delay_s != 0);
    }
}

TEST(ColourDelay, IsToldFromARollingShutter) {
    const ColourDelayEstimator seen = Seen(0.008, 0.025);
    const auto found = seen.Estimate({});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->delay_s, 0.008, 0.001);
    EXPECT_NEAR(found->readout_s, 0.025, 0.003);
    EXPECT_FALSE(found->depth_rolls);
    const auto known = seen.Estimate(0.024);
    ASSERT_TRUE(known);
    EXPECT_NEAR(known->delay_s, 0.008, 0.001);
    EXPECT_EQ(known->readout_s, 0.024);
    EXPECT_FALSE(known->depth_rolls);
}

// Here both cameras' rows are of one time, so if colour is read in 30 ms, depth is, too.
TEST(ColourDelay, SaysThatDepthIsReadAsColourIsWhereThatFitsBetter) {
    const ColourDelayEstimator seen = Seen(0.008);
    const auto found = seen.Estimate(0.03);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->delay_s, 0.008, 0.001);
    EXPECT_EQ(found->readout_s, 0);
    EXPECT_TRUE(found->depth_rolls);
    const auto global = seen.Estimate(0.0);
    ASSERT_TRUE(global);
    EXPECT_NEAR(global->delay_s, 0.008, 0.001);
    EXPECT_FALSE(global->depth_rolls);
    EXPECT_FALSE(seen.Estimate({})->depth_rolls);  // not known
}

TEST(ColourDelay, IsBeyondTheTimeStamps) {
    const auto found = Seen(0.012, 0, 0.015).Estimate({});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->delay_s, -0.003, 0.001);
}

TEST(ColourDelay, IsNotKnownWhenNothingMovesOrTheSearchEnds) {
    EXPECT_FALSE(Seen(0.01, 0, 0, 0).Estimate({}));
    EXPECT_FALSE(Seen(0.06).Estimate({}));
    EXPECT_FALSE(Seen(0.01, 0, 0, 1, 25).Estimate({}));
    EXPECT_TRUE(Seen(0.01, 0, 0, 1, 26).Estimate({}));
    EXPECT_FALSE(Seen(0.06).Estimate(0.0));
    EXPECT_FALSE(ColourDelayEstimator(squares_view::kCamera).Estimate({}));
}

TEST(ColourDelay, IsShownWhereItIsClearAndLarge) {
    EXPECT_TRUE((ColourDelay{.delay_s = -0.0031, .delay_sigma_s = 0.0005}).shown());
    EXPECT_FALSE((ColourDelay{.delay_s = -0.0031, .delay_sigma_s = 0.0006}).shown());
    EXPECT_FALSE((ColourDelay{.delay_s = 0.0015, .delay_sigma_s = 0}).shown());
    EXPECT_NEAR((ColourDelay{.delay_s = -0.009, .delay_sigma_s = 0.001}).certain_s(), -0.007,
                1e-12);
    EXPECT_EQ((ColourDelay{.delay_s = 0.001, .delay_sigma_s = 0.001}).certain_s(), 0);
    EXPECT_EQ(ColourDelayText({.delay_s = -0.0041, .delay_sigma_s = 0.0004}),
              "colour was taken 4.1 +- 0.4 ms earlier than its time stamps say");
}

}  // namespace
}  // namespace tessera
