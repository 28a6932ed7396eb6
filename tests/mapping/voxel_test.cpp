#include "mapping/voxel.h"

#include <gtest/gtest.h>

#include "mapping/analytic_fields.h"

namespace tessera {
namespace {

using testing_support::PackColour;

TEST(Voxel, DistanceBits) {
    EXPECT_EQ(FieldDistance(0x7fff0000u), 1.0f);
    EXPECT_EQ(FieldDistance(0x80010000u), -1.0f);
    EXPECT_EQ(FieldDistance(0x0000ffffu), 0.0f);
    EXPECT_FLOAT_EQ(FieldDistance(0x00010000u), 1.0f / 32767);
    EXPECT_FLOAT_EQ(FieldDistance(0xffffffffu), -1.0f / 32767);
    EXPECT_FALSE(HasDistance(kUnknownField));
    EXPECT_FALSE(HasDistance(0x8000ffffu));
    EXPECT_TRUE(HasDistance(0x80010000u));
    EXPECT_TRUE(HasDistance(0));
}

TEST(Voxel, IntensityBits) {
    EXPECT_FALSE(HasIntensity(kUnknownField));
    EXPECT_FALSE(HasIntensity(0x7fff0000u));
    EXPECT_TRUE(HasIntensity(1));
    EXPECT_EQ(FieldIntensity(0x12340001u), 0.0f);
    EXPECT_EQ(FieldIntensity(0x1234ffffu), 1.0f);
    EXPECT_EQ(FieldIntensity(0x00008000u), 0.5f);
}

TEST(Voxel, ColourOfKnownWords) {
    const LinearRgb grey = ColourFromWords(0x00008000u, kNoColour);
    EXPECT_FLOAT_EQ(grey.r, .5f);
    EXPECT_FLOAT_EQ(grey.g, .5f);
    EXPECT_FLOAT_EQ(grey.b, .5f);
    EXPECT_EQ(ColourWeight(kNoColour), 0);
    EXPECT_EQ(ColourWeight(0x02800000u), 2.5f);
    EXPECT_EQ(ColourWeight(0xffffffffu), 255.9375f);
}

// Packed chroma preserves a colour to within one 8-bit level.
TEST(Voxel, ColourSurvivesPacking) {
    for (int i = 0; i < 1000; ++i) {
        const auto counter = static_cast<std::uint32_t>(3 * i);
        const Eigen::Vector3d rgb(testing_support::Uniform(counter),
                                  testing_support::Uniform(counter + 1),
                                  testing_support::Uniform(counter + 2));
        const LinearRgb back = ColourFromWords(
            testing_support::PackField(0, testing_support::Luma(rgb)), PackColour(rgb));
        ASSERT_NEAR(back.r, rgb.x(), 1.0 / 1022);
        ASSERT_NEAR(back.g, rgb.y(), 1.0 / 1022);
        ASSERT_NEAR(back.b, rgb.z(), 1.0 / 1022);
    }
}

TEST(Voxel, ColourIsClamped) {
    const LinearRgb beyond = ColourFromWords(0x0000ffffu, 1023u << 10);
    EXPECT_EQ(beyond.r, 1.0f);
    EXPECT_GE(beyond.b, 0.0f);
    const LinearRgb below = ColourFromWords(1, 0);
    EXPECT_EQ(below.r, 0.0f);
    EXPECT_EQ(below.b, 0.0f);
}

TEST(Voxel, BlockLimits) {
    EXPECT_TRUE(InLimits({-kBlockLimit, kBlockLimit - 1, 0}));
    EXPECT_FALSE(InLimits({kBlockLimit, 0, 0}));
    EXPECT_FALSE(InLimits({0, -kBlockLimit - 1, 0}));
    EXPECT_FALSE(InLimits({0, 0, kBlockLimit}));
}

TEST(Voxel, BlocksSortByZThenYThenX) {
    EXPECT_LT((BlockCoord{5, 5, -1}), (BlockCoord{-5, -5, 0}));
    EXPECT_LT((BlockCoord{5, -1, 0}), (BlockCoord{-5, 0, 0}));
    EXPECT_LT((BlockCoord{-1, 0, 0}), (BlockCoord{0, 0, 0}));
    EXPECT_FALSE((BlockCoord{1, 2, 3}) < (BlockCoord{1, 2, 3}));
}

}  // namespace
}  // namespace tessera
