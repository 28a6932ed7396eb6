#include "core/image.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(Image, IsRowMajorWithoutPadding) {
    Image<int> image(3, 2, 7);
    EXPECT_EQ(image.size(), 6u);
    EXPECT_EQ(image(2, 1), 7);
    image(1, 0) = 1;
    image(0, 1) = 3;
    EXPECT_EQ(image.data()[1], 1);
    EXPECT_EQ(image.data()[3], 3);
    EXPECT_EQ(image.row(1), image.data() + 3);
}

TEST(Image, KnowsItsPixels) {
    const Image<int> image(3, 2);
    EXPECT_TRUE(image.Contains(0, 0));
    EXPECT_TRUE(image.Contains(2, 1));
    for (const auto& [x, y] : {std::pair{-1, 0}, {0, -1}, {3, 0}, {0, 2}})
        EXPECT_FALSE(image.Contains(x, y)) << x << " " << y;
    EXPECT_FALSE(image.empty());
    EXPECT_TRUE(Image<int>().empty());
}

TEST(Image, CopiesAreDeepAndResizingKeepsTheStorage) {
    ColourImage image(4, 4, Rgb8{1, 2, 3});
    const ColourImage copy = image;
    image(0, 0).r = 9;
    EXPECT_EQ(copy(0, 0), (Rgb8{1, 2, 3}));
    EXPECT_FALSE(copy == image);
    const Rgb8* storage = image.data();
    image.Resize(2, 3);
    EXPECT_EQ(image.width(), 2);
    EXPECT_EQ(image.height(), 3);
    EXPECT_EQ(image.size(), 6u);
    EXPECT_EQ(image.data(), storage);
}

}  // namespace
}  // namespace tessera
