#include "mapping/frame_kernels.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessera {
namespace {

TEST(FrameKernels, DepthIsCorrectedAndGated) {
    EXPECT_FLOAT_EQ(CorrectedDepth(2.0f, 0.05f), 2.0f / 1.1f);
    EXPECT_EQ(CorrectedDepth(1.7f, 0.0f), 1.7f);
    EXPECT_TRUE(InRange(0.3f, 0.3f, 5.0f));
    EXPECT_FALSE(InRange(5.01f, 0.3f, 5.0f));
    EXPECT_FALSE(InRange(std::numeric_limits<float>::quiet_NaN(), 0.3f, 5.0f));
    EXPECT_TRUE(Coherent(2.0f, 2.09f));
    EXPECT_FALSE(Coherent(2.0f, 1.9f));
}

// Grey has zero chroma.
TEST(FrameKernels, ColourIsPackedAsLumaAndChroma) {
    EXPECT_FLOAT_EQ(Luma255({255, 255, 255}), 255.0f);
    EXPECT_FLOAT_EQ(Luma255({0, 200, 0}), 117.4f);
    EXPECT_EQ(PackColour({90, 90, 90}, 1.0f), 0x8080ffffu);
    const std::uint32_t red = PackColour({250, 0, 0}, 0.0f);
    EXPECT_EQ(red >> 24, 253u);        // 128.5 + 0.701 * 250 / 1.402
    EXPECT_EQ(red >> 16 & 255u, 86u);  // 128.5 - 0.299 * 250 / 1.772
    EXPECT_EQ(red & 0xffffu, 0u);
}

// These chroma values are half a step above the largest byte. They must neither wrap around nor
// spill into the neighbouring byte.
TEST(FrameKernels, PureRedAndBlueHaveTheLargestChroma) {
    EXPECT_EQ(PackColour({255, 0, 0}, 0.0f) >> 24, 255u);
    // Cr: 128.5 - 0.114 * 255 / 1.402.
    EXPECT_EQ(PackColour({0, 0, 255}, 0.0f), 107u << 24 | 255u << 16);
}

TEST(FrameKernels, SmoothingIsTheBinomialWithTheBorderRepeated) {
    const float point[] = {0, 0, 16, 0, 0}, none[5] = {};
    const RowsAround on{none, point, none}, beside{point, none, none},
        corner{point + 2, point + 2, none};
    EXPECT_EQ(SmoothInside(on, 2), 4.0f);
    EXPECT_EQ(SmoothAt(on, 1, 5), 2.0f);
    EXPECT_EQ(SmoothAt(beside, 2, 5), 2.0f);
    EXPECT_EQ(SmoothAt(beside, 3, 5), 1.0f);
    // The corner pixel has the weight (1 + 2) (1 + 2) / 16.
    EXPECT_EQ(SmoothAt(corner, 0, 3), 9.0f);
    EXPECT_EQ(SmoothAt({none, point, none}, 2, 3), 6.0f);
}

}  // namespace
}  // namespace tessera
