#include "io/image_header.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <vector>

namespace tessera {
namespace {

std::vector<std::uint8_t> Encoded(const std::string& extension, int type = CV_8UC3) {
    std::vector<std::uint8_t> file;
    cv::imencode(extension, cv::Mat(53, 75, type, cv::Scalar::all(9)), file);
    return file;
}

std::vector<std::uint8_t> BytesOf(const std::string& text) { return {text.begin(), text.end()}; }

TEST(ImageHeader, GivesTheSizeThatOpenCvDecodes) {
    for (const char* extension : {".png", ".jpg", ".ppm", ".bmp", ".tiff"}) {
        const auto size = ReadImageSize(Encoded(extension));
        ASSERT_TRUE(size) << extension;
        EXPECT_EQ(*size, (ImageSize{75, 53})) << extension;
    }
    for (const char* extension : {".png", ".pgm", ".tiff"})
        EXPECT_EQ(ReadImageSize(Encoded(extension, CV_16UC1)), (ImageSize{75, 53})) << extension;
}

TEST(ImageHeader, ReadsEveryWritingOfASize) {
    EXPECT_EQ(ReadImageSize(BytesOf("P5 #a comment 9 9\n 640\t#\n480 255\n")),
              (ImageSize{640, 480}));
    // Big-endian TIFF, width as two bytes and height as four.
    const std::string tiff(
        "MM\0*\0\0\0\x08\0\x02\x01\0\0\x03\0\0\0\x01\x02\x80\0\0"
        "\x01\x01\0\x04\0\0\0\x01\0\0\x01\xe0",
        34);
    EXPECT_EQ(ReadImageSize(BytesOf(tiff)), (ImageSize{640, 480}));
    std::vector<std::uint8_t> bmp = Encoded(".bmp");
    const std::int32_t upside_down = -53;
    std::memcpy(&bmp[22], &upside_down, 4);
    EXPECT_EQ(ReadImageSize(bmp), (ImageSize{75, 53}));
}

TEST(ImageHeader, KnowsNoSizeOfWhatItDoesNotRead) {
    for (const char* text : {"", "P", "P5", "P5 -3 4", "P9 640 480", "GIF89a", "BM", "P5 0 4 255"})
        EXPECT_FALSE(ReadImageSize(BytesOf(text))) << text;
    EXPECT_FALSE(ReadImageSize(Encoded(".webp")));
    EXPECT_FALSE(ReadImageSize(BytesOf("P5 99999999999999999999 4 255")));
    // Cut anywhere or damaged anywhere, it never reads beyond its end.
    std::mt19937 random(7);
    for (const char* extension : {".png", ".jpg", ".ppm", ".bmp", ".tiff"}) {
        const std::vector<std::uint8_t> whole = Encoded(extension);
        for (std::size_t length = 0; length < 300 && length < whole.size(); ++length)
            (void)ReadImageSize({whole.data(), length});
        for (int i = 0; i < 2000; ++i) {
            std::vector<std::uint8_t> file = whole;
            for (int n = 0; n < 3; ++n)
                file[random() % std::min<std::size_t>(file.size(), 200)] =
                    static_cast<std::uint8_t>(random());
            (void)ReadImageSize(file);
        }
    }
}

}  // namespace
}  // namespace tessera
