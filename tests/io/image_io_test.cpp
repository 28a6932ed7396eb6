#include "io/image_io.h"

#include <gtest/gtest.h>

#include "io/temporary_folder.h"

namespace tessera {
namespace {

TEST(ImageIo, WritesAndReadsBackEveryPixel) {
    TemporaryFolder folder;
    ColourImage colour(31, 7);
    Image<std::uint16_t> depth(31, 7);
    Image<std::uint8_t> grey(31, 7);
    for (std::size_t i = 0; i < colour.size(); ++i) {
        const auto byte = static_cast<std::uint8_t>(i);
        colour.data()[i] = {byte, static_cast<std::uint8_t>(2 * i),
                            static_cast<std::uint8_t>(7 * i)};
        depth.data()[i] = static_cast<std::uint16_t>(300 * i);
        grey.data()[i] = byte;
    }
    ASSERT_TRUE(WriteColourImage(folder.Path("colour.png"), colour).ok());
    ASSERT_TRUE(WriteDepthImage(folder.Path("depth.png"), depth).ok());
    ASSERT_TRUE(WriteGreyImage(folder.Path("grey.png"), grey).ok());
    EXPECT_EQ(ReadColourImage(folder.Path("colour.png")).value(), colour);
    EXPECT_EQ(ReadDepthImage(folder.Path("depth.png")).value(), depth);
    EXPECT_EQ(ReadColourImage(folder.Path("grey.png")).value()(30, 6), (Rgb8{216, 216, 216}));
}

TEST(ImageIo, WritesJpegByExtension) {
    TemporaryFolder folder;
    ASSERT_TRUE(
        WriteColourImage(folder.Path("colour.jpg"), ColourImage(32, 16, {200, 100, 50})).ok());
    EXPECT_EQ(ReadText(folder.Path("colour.jpg")).substr(0, 2), "\xff\xd8");
    const Rgb8 pixel = ReadColourImage(folder.Path("colour.jpg")).value()(5, 5);
    EXPECT_NEAR(pixel.r, 200, 3);
    EXPECT_NEAR(pixel.g, 100, 3);
    EXPECT_NEAR(pixel.b, 50, 3);
}

TEST(ImageIo, SaysWhyNothingWasWritten) {
    TemporaryFolder folder;
    const ColourImage image(8, 8);
    EXPECT_EQ(WriteColourImage(folder.Path("a.unknown"), image).message(),
              folder.Path("a.unknown") + ": is not a supported image format; use .png");
    EXPECT_EQ(WriteColourImage(folder.Path("absent/a.png"), image).message(),
              folder.Path("absent/a.png") +
                  ": cannot be written: the folder does not exist; create it or choose another "
                  "location");
    EXPECT_EQ(WriteColourImage(folder.Path("a.png"), {}).message(),
              folder.Path("a.png") + ": there are no pixels to write");
}

}  // namespace
}  // namespace tessera
