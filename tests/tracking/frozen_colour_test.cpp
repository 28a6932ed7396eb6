#include "tracking/frozen_colour.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

Frame FrameOf(std::uint8_t shade, float depth_m) {
    Frame frame;
    frame.colour = ColourImage(4, 3, Rgb8{90, 80, 70});
    frame.colour(3, 0) = {shade, shade, shade};
    frame.depth_m = DepthImage(4, 3, 2.0f);
    frame.depth_m(3, 0) = depth_m;
    return frame;
}

TEST(FrozenColour, RepeatsWhileTheDepthGoesOn) {
    FrozenColour frozen;
    EXPECT_FALSE(frozen.Repeats(FrameOf(1, 1)));
    EXPECT_TRUE(frozen.Repeats(FrameOf(1, 2)));
    EXPECT_TRUE(frozen.Repeats(FrameOf(1, 3)));
    EXPECT_FALSE(frozen.Repeats(FrameOf(2, 4)));
    EXPECT_TRUE(frozen.Repeats(FrameOf(2, 5)));
    frozen.Clear();
    EXPECT_FALSE(frozen.Repeats(FrameOf(2, 6)));
}

TEST(FrozenColour, HangsWhereOneImageComesForHalfASecond) {
    FrozenColour frozen;
    double stamp_s = 10;
    const auto hangs = [&](std::uint8_t shade) {
        stamp_s += 0.125;
        Frame frame = FrameOf(shade, static_cast<float>(stamp_s));
        frame.stamp_s = stamp_s;
        frozen.Repeats(frame);
        return frozen.hangs();
    };
    for (std::uint8_t i = 0; i < 8; ++i) EXPECT_FALSE(hangs(i / 2)) << i;  // at half the rate
    for (int i = 0; i < 8; ++i) EXPECT_EQ(hangs(9), i >= 4) << i;
    EXPECT_FALSE(hangs(10));
}

TEST(FrozenColour, AStillSceneIsNotFrozen) {
    FrozenColour frozen;
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(frozen.Repeats(FrameOf(1, 1)));
}

TEST(FrozenColour, NorIsABareWallOrAFrameWithoutColour) {
    FrozenColour frozen;
    for (int i = 0; i < 3; ++i) {
        Frame wall = FrameOf(1, 1.0f + static_cast<float>(i));
        wall.colour = ColourImage(4, 3, Rgb8{200, 200, 200});
        EXPECT_FALSE(frozen.Repeats(wall));
        wall.colour = {};
        EXPECT_FALSE(frozen.Repeats(wall));
    }
}

}  // namespace
}  // namespace tessera
