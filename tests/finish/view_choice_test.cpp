#include "finish/view_choice.h"

#include <gtest/gtest.h>

#include "finish/wall_frames.h"

namespace tessera {
namespace {

using testing_support::WallFrame;

Frame Numbered(std::int64_t index, double x_m, bool blurred) {
    Frame frame = WallFrame({x_m, 0, -1}, 0);
    frame.index = index;
    if (blurred) frame.colour = ColourImage(160, 120, Rgb8{100, 100, 100});
    return frame;
}

TEST(ViewChoice, TakesTheSharpestOfEachStretch) {
    ViewChoice choice;
    std::vector<std::int64_t> chosen;
    for (std::int64_t i = 0; i < 25; ++i) {
        const auto frame = choice.Offer(Numbered(i, 0.01 * static_cast<double>(i), i % 11 != 4));
        if (frame) chosen.push_back(frame->index);
    }
    // 0.05 m are six frames or, by rounding, five; of equally blurred ones the first is taken.
    ASSERT_EQ(chosen, (std::vector<std::int64_t>{4, 6, 15, 17}));
    const auto last = choice.Last();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->index, 23);
    EXPECT_FALSE(choice.Last());
}

TEST(ViewChoice, ATurnIsAStretchToo) {
    ViewChoice choice;
    int chosen = 0;
    for (int i = 0; i <= 30; ++i)
        chosen += choice.Offer(WallFrame({0, 0, -1}, 0.025 * i)).has_value();
    EXPECT_EQ(chosen, 10);  // 0.75 rad
}

}  // namespace
}  // namespace tessera
