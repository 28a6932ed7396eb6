// Tests of preparing a frame without its moving regions.
#include "mapping/moving_mask.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mapping/prepared_frame.h"

namespace tessera {
namespace {

// 23 x 17 pixels in tiles of 5. The last tile of a row or column also holds the remaining pixels.
struct MaskedFrame {
    Frame frame;
    MovingMask mask;

    MaskedFrame() {
        frame.depth_m = DepthImage(23, 17);
        for (int y = 0; y < 17; ++y)
            for (int x = 0; x < 23; ++x)
                frame.depth_m(x, y) = 1.0f + 0.01f * static_cast<float>(x + 2 * y);
        frame.colour = ColourImage(23, 17, {90, 60, 50});
        mask.step = 5;
        mask.moving = Image<std::uint8_t>(4, 3);
        mask.moving(1, 0) = mask.moving(3, 1) = mask.moving(0, 2) = mask.moving(3, 2) = 1;
    }
    // Follows the definition of a tile.
    bool Moves(int x, int y) const {
        return mask.moving(std::min(x / 5, 3), std::min(y / 5, 2)) != 0;
    }
};

TEST(MovingMask, AFrameIsPreparedWithoutIt) {
    const MaskedFrame masked;
    PreparedFrame prepared;
    PrepareFrame(masked.frame, {}, prepared, &masked.mask);
    std::int64_t left = 0;
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 23; ++x) {
            EXPECT_EQ(prepared.depth_m(x, y),
                      masked.Moves(x, y) ? 0.0f : masked.frame.depth_m(x, y))
                << x << " " << y;
            left += !masked.Moves(x, y);
        }
    EXPECT_EQ(prepared.valid_depth_pixels, left);
    EXPECT_EQ(prepared.measured_pixels, left);
    const Frame rest = WithoutMoving(masked.mask, masked.frame);
    for (std::size_t i = 0; i < rest.depth_m.size(); ++i)
        EXPECT_EQ(rest.depth_m.data()[i], prepared.depth_m.data()[i]) << i;
}

TEST(MovingMask, AFrameIsPreparedAgainWithAnotherAndKeepsItsColour) {
    const MaskedFrame masked;
    PreparedFrame whole, again;
    PrepareFrame(masked.frame, {}, whole);
    PrepareFrame(masked.frame, {}, again, &masked.mask);
    RemaskDepth(masked.frame, {}, again, nullptr);
    EXPECT_EQ(again.valid_depth_pixels, 23 * 17);
    EXPECT_NE(again.identity, whole.identity);
    for (std::size_t i = 0; i < whole.depth_m.size(); ++i) {
        EXPECT_EQ(again.depth_m.data()[i], whole.depth_m.data()[i]) << i;
        EXPECT_EQ(again.packed_colour.data()[i], whole.packed_colour.data()[i]) << i;
    }
    for (std::size_t level = 0; level < whole.reduced.size(); ++level)
        for (std::size_t i = 0; i < whole.reduced[level].depth_m.size(); ++i)
            EXPECT_EQ(again.reduced[level].depth_m.data()[i],
                      whole.reduced[level].depth_m.data()[i])
                << level << " " << i;
}

}  // namespace
}  // namespace tessera
