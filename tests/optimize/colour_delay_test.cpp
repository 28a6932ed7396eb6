#include "optimize/colour_delay.h"

#include <gtest/gtest.h>

#include "optimize/squares_view.h"

namespace tessera {
namespace {

// Colour's stamps say `stamped_s` of the delay. The camera moves at `speed` times its usual one.
std::optional<ColourDelay> Estimate(double delay_s, double readout_s = 0, double stamped_s = 0,
                                    double speed = 1, int views = 40) {
    ColourDelayEstimator estimator(squares_view::kCamera);
    for (int i = 0; i < views; ++i) {
        Frame frame = squares_view::View(0.1 * i * speed, delay_s * speed, readout_s * speed);
        frame.stamp_s = 0.1 * i;
        frame.colour_stamp_s = frame.stamp_s + stamped_s;
        estimator.Add(frame, MakeEdgeView(frame));
    }
    return estimator.Estimate();
}

TEST(ColourDelay, IsFound) {
    for (const double delay_s : {-0.011, 0.0, 0.007, 0.02}) {
        const auto found = Estimate(delay_s);
        ASSERT_TRUE(found) << delay_s;
        EXPECT_NEAR(found->delay_s, delay_s, 0.001);
        EXPECT_NEAR(found->readout_s, 0, 0.003);
        EXPECT_EQ(found->shown(), delay_s != 0);
    }
}

TEST(ColourDelay, IsToldFromARollingShutter) {
    const auto found = Estimate(0.008, 0.025);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->delay_s, 0.008, 0.001);
    EXPECT_NEAR(found->readout_s, 0.025, 0.003);
}

TEST(ColourDelay, IsBeyondTheTimeStamps) {
    const auto found = Estimate(0.012, 0, 0.015);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->delay_s, -0.003, 0.001);
}

TEST(ColourDelay, IsNotKnownWhenNothingMovesOrTheSearchEnds) {
    EXPECT_FALSE(Estimate(0.01, 0, 0, 0));
    EXPECT_FALSE(Estimate(0.06));
    EXPECT_FALSE(Estimate(0.01, 0, 0, 1, 25));
    EXPECT_TRUE(Estimate(0.01, 0, 0, 1, 26));
    EXPECT_FALSE(ColourDelayEstimator(squares_view::kCamera).Estimate());
}

TEST(ColourDelay, IsShownWhereItIsClearAndLarge) {
    EXPECT_TRUE((ColourDelay{.delay_s = -0.0025, .delay_sigma_s = 0.0004}).shown());
    EXPECT_FALSE((ColourDelay{.delay_s = -0.0025, .delay_sigma_s = 0.0005}).shown());
    EXPECT_FALSE((ColourDelay{.delay_s = 0.0015, .delay_sigma_s = 0.0001}).shown());
    EXPECT_NEAR((ColourDelay{.delay_s = -0.009, .delay_sigma_s = 0.001}).certain_s(), -0.007,
                1e-12);
    EXPECT_EQ((ColourDelay{.delay_s = 0.001, .delay_sigma_s = 0.001}).certain_s(), 0);
    EXPECT_EQ(ColourDelayText({.delay_s = -0.0041, .delay_sigma_s = 0.0004}),
              "colour was taken 4.1 +- 0.4 ms earlier than its time stamps say");
}

// Against a colour image that is read in 30 ms.
TEST(ColourDelay, SaysThatDepthRollsWhereThatIsMoreLikely) {
    EXPECT_TRUE((ColourDelay{.readout_s = -0.007, .readout_sigma_s = 0.010}).DepthRolls(0.03));
    EXPECT_TRUE((ColourDelay{.readout_s = 0.004, .readout_sigma_s = 0.012}).DepthRolls(0.03));
    EXPECT_FALSE((ColourDelay{.readout_s = 0.004, .readout_sigma_s = 0.015}).DepthRolls(0.03));
    EXPECT_FALSE((ColourDelay{.readout_s = 0.016, .readout_sigma_s = 0.001}).DepthRolls(0.03));
    EXPECT_FALSE((ColourDelay{.readout_s = 0.029, .readout_sigma_s = 0.003}).DepthRolls(0.03));
    EXPECT_FALSE((ColourDelay{.readout_s = 0.001, .readout_sigma_s = 0.001}).DepthRolls(0));
}

}  // namespace
}  // namespace tessera
