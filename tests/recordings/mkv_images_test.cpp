#include "recordings/mkv_images.h"

#include <gtest/gtest.h>

#include <vector>

#include "io/jpeg_encoder.h"

namespace tessera {
namespace {

constexpr ImageSize kMkvTwoByTwo{2, 2};

// Luma and chroma of red, by ITU-R BT.601 in 16 to 235.
constexpr std::uint8_t kRedY = 81, kRedU = 90, kRedV = 240;

void ExpectRedish(const ColourImage& colour, int x, int y) {
    EXPECT_NEAR(colour(x, y).r, 255, 2);
    EXPECT_NEAR(colour(x, y).g, 0, 2);
    EXPECT_NEAR(colour(x, y).b, 0, 2);
}

TEST(MkvImages, Depth) {
    Image<std::uint16_t> depth;
    const std::vector<std::uint8_t> bytes{0x01, 0x02, 0, 5, 0xff, 0xfe, 0, 0};
    ASSERT_TRUE(DecodeMkvDepth(bytes, kMkvTwoByTwo, depth).ok());
    EXPECT_EQ(depth(0, 0), 0x0102);
    EXPECT_EQ(depth(1, 0), 5);
    EXPECT_EQ(depth(0, 1), 0xfffe);
    EXPECT_EQ(depth(1, 1), 0);
    const Status status = DecodeMkvDepth(MkvBytes(bytes).first(7), kMkvTwoByTwo, depth);
    EXPECT_EQ(status.message(), "has 7 bytes instead of 8");
    EXPECT_TRUE(IsMkvDepthFormat("b16g"));
    EXPECT_FALSE(IsMkvDepthFormat("MJPG"));
}

TEST(MkvImages, ColourWithoutCompression) {
    ColourImage colour;
    const std::vector<std::uint8_t> bgra{1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 0};
    ASSERT_TRUE(DecodeMkvColour("BGRA", bgra, kMkvTwoByTwo, colour).ok());
    EXPECT_EQ(colour(0, 0), (Rgb8{3, 2, 1}));
    EXPECT_EQ(colour(1, 1), (Rgb8{12, 11, 10}));

    const std::vector<std::uint8_t> nv12{kRedY, kRedY, 16, kRedY, kRedU, kRedV};
    ASSERT_TRUE(DecodeMkvColour("NV12", nv12, kMkvTwoByTwo, colour).ok());
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}}) ExpectRedish(colour, x, y);
    EXPECT_LT(colour(0, 1).r, 200);

    const std::vector<std::uint8_t> yuy2{kRedY, kRedU, kRedY, kRedV, 16, kRedU, kRedY, kRedV};
    ASSERT_TRUE(DecodeMkvColour("YUY2", yuy2, kMkvTwoByTwo, colour).ok());
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}}) ExpectRedish(colour, x, y);
    EXPECT_LT(colour(0, 1).r, 200);

    for (const char* format : {"BGRA", "NV12", "YUY2"}) {
        EXPECT_TRUE(IsMkvColourFormat(format));
        const Status status =
            DecodeMkvColour(format, MkvBytes(bgra).first(5), kMkvTwoByTwo, colour);
        EXPECT_NE(status.message().find("has 5 bytes instead of"), std::string::npos);
        EXPECT_FALSE(DecodeMkvColour(format, bgra, {1, 4}, colour).ok());
    }
    EXPECT_FALSE(IsMkvColourFormat("V_VP9"));
}

TEST(MkvImages, AJpegOfAnotherSizeIsRefused) {
    ASSERT_TRUE(IsMkvColourFormat("MJPG"));
    std::vector<std::uint8_t> jpeg;
    ASSERT_TRUE(EncodeJpeg(ColourImage(32, 16, {10, 200, 30}), 95, jpeg).ok());
    ColourImage colour;
    ASSERT_TRUE(DecodeMkvColour("MJPG", jpeg, {32, 16}, colour).ok());
    EXPECT_NEAR(colour(5, 5).g, 200, 4);
    EXPECT_EQ(DecodeMkvColour("MJPG", jpeg, {16, 32}, colour).message(),
              "is no JPEG image of 16 x 32 pixels");
    EXPECT_FALSE(DecodeMkvColour("MJPG", {}, {32, 16}, colour).ok());
}

}  // namespace
}  // namespace tessera
