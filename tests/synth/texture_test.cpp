#include "synth/texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "synth/paint.h"

namespace tessera {
namespace {

ColourImage TwoByTwo() {
    ColourImage image(2, 2);
    image(0, 0) = {0, 40, 80};
    image(1, 0) = {100, 40, 80};
    image(0, 1) = {0, 140, 80};
    image(1, 1) = {100, 140, 80};
    return image;
}

TEST(Texture, IsExactAtTexelCentresAndLinearBetween) {
    const Texture texture(TwoByTwo(), Texture::Wrap::kClamp);
    const RgbF corner = texture.Sample(0.25f, 0.75f, 0);
    EXPECT_FLOAT_EQ(corner.r, 0);
    EXPECT_FLOAT_EQ(corner.g, 140);
    EXPECT_FLOAT_EQ(corner.b, 80);
    EXPECT_FLOAT_EQ(texture.Sample(0.5f, 0.25f, 0).r, 50);
    EXPECT_FLOAT_EQ(texture.Sample(0.375f, 0.25f, 0).r, 25);
}

TEST(Texture, ClampContinuesTheBorderAndRepeatWraps) {
    const Texture clamped(TwoByTwo(), Texture::Wrap::kClamp),
        repeated(TwoByTwo(), Texture::Wrap::kRepeat);
    EXPECT_FLOAT_EQ(clamped.Sample(-3.0f, 0.25f, 0).r, 0);
    EXPECT_FLOAT_EQ(clamped.Sample(7.0f, 0.25f, 0).r, 100);
    EXPECT_FLOAT_EQ(repeated.Sample(-0.25f, 0.25f, 0).r, 100);
    EXPECT_FLOAT_EQ(repeated.Sample(3.0f, 0.25f, 0).r,
                    50);  // halfway between the last and the first column
}

TEST(Texture, AWideFootprintGivesTheMean) {
    const Texture texture(PaintChecker({0, 0, 0}, {200, 200, 200}, 32, 32, 64),
                          Texture::Wrap::kRepeat);
    EXPECT_NEAR(texture.Sample(0.3f, 0.6f, 1.0f).g, 100, 1);
    EXPECT_NEAR(texture.Sample(0.31f, 0.61f, 50.0f).g, 100, 1);
}

TEST(Texture, RepeatingPatternsHaveNoSeam) {
    for (const ColourImage& image : {PaintNoise({120, 120, 120}, 60, 256, 3),
                                     PaintTiles({120, 120, 120}, {90, 90, 90}, 4, 256, 3)}) {
        double seam = 0, inside = 0;
        for (int y = 0; y < 256; ++y) {
            seam += std::abs(image(255, y).g - image(0, y).g);
            inside += std::abs(image(128, y).g - image(127, y).g) +
                      std::abs(image(70, y).g - image(71, y).g);
        }
        EXPECT_LE(seam, 2.5 * inside + 256);
    }
}

}  // namespace
}  // namespace tessera
