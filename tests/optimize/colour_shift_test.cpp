#include "optimize/colour_shift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optimize/box_view.h"

namespace tessera {
namespace {

std::optional<ColourShift> ShiftOf(int x, int y, int shadow_px = 0) {
    ColourShiftEstimator estimator;
    for (int i = 0; i < 16; ++i) estimator.Add(MakeEdgeView(BoxView(i, x, y, shadow_px)));
    return estimator.Estimate();
}

TEST(ColourShift, FindsHowFarColourWasMoved) {
    for (const auto& [x, y] : {std::pair(0, 0), {12, -7}, {-20, 16}, {3, 30}}) {
        const auto shift = ShiftOf(x, y);
        ASSERT_TRUE(shift);
        EXPECT_NEAR(shift->x_px, x, 0.5) << x << ' ' << y;
        EXPECT_NEAR(shift->y_px, y, 0.5) << x << ' ' << y;
        EXPECT_EQ(shift->width_px, kBoxViewWidth);
        EXPECT_EQ(shift->shown(), x != 0);
    }
}

TEST(ColourShift, AShadowBesideTheSurfaceDoesNotMisleadIt) {
    const auto shift = ShiftOf(10, -8, 20);
    ASSERT_TRUE(shift);
    EXPECT_NEAR(shift->x_px, 10, 0.5);
    EXPECT_NEAR(shift->y_px, -8, 0.5);
}

// One percent of the width if the registration was given, half of that if it was a guess.
TEST(ColourShift, IsShownWhereItIsClearAndLarge) {
    ColourShift shift{.x_px = 4, .sigma_x_px = 0.1, .sigma_y_px = 0.1, .width_px = 640};
    EXPECT_FALSE(shift.shown());
    shift.known = false;
    EXPECT_TRUE(shift.shown());
    shift.sigma_x_px = 1;
    EXPECT_FALSE(shift.shown());
    shift = {.y_px = -7, .sigma_x_px = 0.1, .sigma_y_px = 1, .width_px = 640};
    EXPECT_TRUE(shift.shown());
    shift.width_px = 1280;
    EXPECT_FALSE(shift.shown());
    EXPECT_EQ(ColourShiftText(shift),
              "colour lies 0.0 +- 0.1 px left of and 7.0 +- 1.0 px above where depth puts it");
}

TEST(EdgeView, HasAbout320Columns) {
    for (const auto& [width, step] : {std::pair(240, 1),
                                      {320, 1},
                                      {479, 1},
                                      {480, 2},
                                      {639, 2},
                                      {640, 2},
                                      {960, 3},
                                      {1280, 4}}) {
        Frame frame;
        frame.depth_m = DepthImage(width, 120, 3.0f);
        frame.colour = ColourImage(width, 120, {90, 120, 80});
        const EdgeView view = MakeEdgeView(frame);
        EXPECT_EQ(view.step_px, step) << width;
        EXPECT_EQ(view.across.width(), width / step) << width;
    }
}

TEST(ColourShift, SaysNothingWithoutEdgesThatMeet) {
    EXPECT_FALSE(ShiftOf(60, 0));  // beyond the search
    ColourShiftEstimator none, flat, no_colour;
    EXPECT_FALSE(none.Estimate());
    for (int i = 0; i < 16; ++i) {
        Frame frame = BoxView(i, 0, 0);
        frame.depth_m = DepthImage(kBoxViewWidth, kBoxViewHeight, 3.0f);
        flat.Add(MakeEdgeView(frame));
        frame = BoxView(i, 0, 0);
        frame.colour = {};
        no_colour.Add(MakeEdgeView(frame));
    }
    EXPECT_FALSE(flat.Estimate());
    EXPECT_FALSE(no_colour.Estimate());
}

}  // namespace
}  // namespace tessera
