// Checks png_encoder.h and jpeg_encoder.h against our decoders and those of OpenCV.
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "io/jpeg_decoder.h"
#include "io/jpeg_encoder.h"
#include "io/png_encoder.h"

namespace tessera {
namespace {

Image<std::uint16_t> SomeDepth(int width, int height) {
    Image<std::uint16_t> depth(width, height);
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        state = state * 1664525 + 1013904223;
        depth.data()[i] = static_cast<std::uint16_t>(i % 7 == 0 ? 0 : state >> 16);
    }
    return depth;
}

ColourImage SmoothColour(int width, int height) {
    ColourImage colour(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            colour(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(2 * y),
                            static_cast<std::uint8_t>(x + y)};
    return colour;
}

TEST(PngEncoder, DepthComesBackExactly) {
    PngEncoder encoder;
    std::vector<std::uint8_t> file;
    for (const auto& [width, height] : {std::pair{64, 48}, {1, 1}, {7, 3}}) {
        const auto depth = SomeDepth(width, height);
        encoder.EncodeDepth(depth, file);
        const cv::Mat read = cv::imdecode(file, cv::IMREAD_UNCHANGED);
        ASSERT_EQ(read.type(), CV_16UC1);
        ASSERT_EQ(read.cols, width);
        ASSERT_EQ(read.rows, height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                ASSERT_EQ(read.at<std::uint16_t>(y, x), depth(x, y)) << x << ' ' << y;
    }
}

TEST(PngEncoder, ColourComesBackExactly) {
    PngEncoder encoder;
    std::vector<std::uint8_t> file;
    const ColourImage colour = SmoothColour(61, 40);
    encoder.EncodeColour(colour, file);
    const cv::Mat read = cv::imdecode(file, cv::IMREAD_UNCHANGED);
    ASSERT_EQ(read.type(), CV_8UC3);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 61; ++x) {
            const auto bgr = read.at<cv::Vec3b>(y, x);
            ASSERT_EQ((Rgb8{bgr[2], bgr[1], bgr[0]}), colour(x, y));
        }
}

TEST(JpegEncoder, ComesBackAlmost) {
    std::vector<std::uint8_t> file;
    const ColourImage colour = SmoothColour(64, 48);
    ASSERT_TRUE(EncodeJpeg(colour, 95, file).ok());
    ColourImage read;
    ASSERT_TRUE(DecodeJpeg(file, 1000, read).ok());
    ASSERT_EQ(read.width(), 64);
    for (std::size_t i = 0; i < read.size(); ++i) {
        ASSERT_LE(std::abs(read.data()[i].r - colour.data()[i].r), 6);
        ASSERT_LE(std::abs(read.data()[i].g - colour.data()[i].g), 6);
        ASSERT_LE(std::abs(read.data()[i].b - colour.data()[i].b), 6);
    }
}

TEST(JpegEncoder, SaysWhatItRefuses) {
    std::vector<std::uint8_t> file;
    EXPECT_NE(
        EncodeJpeg(ColourImage(70000, 1), 95, file).message().find("cannot be encoded as JPEG"),
        std::string::npos);
}

}  // namespace
}  // namespace tessera
