#include "io/openni_modes.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

using Choice = std::pair<std::size_t, std::size_t>;

TEST(OpenniModes, Takes640x480x30WhereItIs) {
    const std::vector<StreamMode> depth = {
        {320, 240, 60}, {640, 480, 60}, {640, 480, 30}, {1280, 1024, 30}};
    const std::vector<StreamMode> colour = {{1280, 1024, 30}, {640, 480, 30}, {320, 240, 60}};
    EXPECT_EQ(ChooseModes(depth, colour), Choice(2, 1));
}

TEST(OpenniModes, ElseTheNearestSizeThatBothHave) {
    EXPECT_EQ(ChooseModes({{320, 240, 30}, {640, 480, 30}}, {{1280, 960, 30}, {320, 240, 15}}),
              Choice(0, 1));
    EXPECT_EQ(ChooseModes({{640, 480, 15}, {640, 480, 60}}, {{640, 480, 30}}), Choice(0, 0));
    EXPECT_FALSE(ChooseModes({{640, 480, 30}}, {{1280, 960, 30}}));
    EXPECT_FALSE(ChooseModes({}, {{640, 480, 30}}));
}

TEST(OpenniModes, PixelsThatCannotBeReadAreLeftOut) {
    EXPECT_EQ(ChooseModes({{640, 480, 30}},
                          {{640, 480, 30, false}, {320, 240, 30}, {640, 480, 15, true, 1}}),
              Choice(0, 2));
    EXPECT_EQ(ChooseModes({{640, 480, 30, true, 1}, {640, 480, 30, true, 0}}, {{640, 480, 30}}),
              Choice(1, 0));
    EXPECT_FALSE(ChooseModes({{640, 480, 30, false}}, {{640, 480, 30}}));
}

}  // namespace
}  // namespace tessera
