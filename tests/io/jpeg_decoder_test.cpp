#include "io/jpeg_decoder.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <random>
#include <vector>

namespace tessera {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kLimit_px = 8192;

cv::Mat SmoothPicture(int type) {
    cv::Mat picture(53, 75, type);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols * picture.channels(); ++x)
            picture.data[static_cast<std::size_t>(y) * picture.step + static_cast<std::size_t>(x)] =
                static_cast<std::uint8_t>((x * x / 40 + 3 * y) & 0xff);
    return picture;
}

Bytes MakeJpeg(int type) {
    Bytes file;
    cv::imencode(".jpg", SmoothPicture(type), file, {cv::IMWRITE_JPEG_QUALITY, 85});
    return file;
}

TEST(JpegDecoder, GivesOpenCvsPixelsInRgbOrder) {
    for (int type : {CV_8UC3, CV_8UC1}) {
        const Bytes file = MakeJpeg(type);
        ASSERT_TRUE(IsJpeg(file));
        ColourImage image;
        ASSERT_TRUE(DecodeJpeg(file, kLimit_px, image).ok());
        const cv::Mat expected = cv::imdecode(file, cv::IMREAD_COLOR);
        ASSERT_EQ(image.width(), expected.cols);
        ASSERT_EQ(image.height(), expected.rows);
        for (int y = 0; y < expected.rows; ++y)
            for (int x = 0; x < expected.cols; ++x) {
                const auto bgr = expected.at<cv::Vec3b>(y, x);
                ASSERT_EQ(image(x, y), (Rgb8{bgr[2], bgr[1], bgr[0]})) << x << " " << y;
            }
    }
}

TEST(JpegDecoder, RefusesTruncatedData) {
    const Bytes file = MakeJpeg(CV_8UC3);
    ColourImage image;
    for (std::size_t cut : {2u, 10u, 50u, 400u, 700u}) {
        const std::span<const std::uint8_t> part(file.data(), file.size() - cut);
        const Status status = DecodeJpeg(part, kLimit_px, image);
        EXPECT_NE(status.message().find("is truncated or damaged"), std::string::npos) << cut;
    }
}

// A progressive image of many empty scans: each costs as much as a whole image, and a few bytes.
TEST(JpegDecoder, RefusesManyScans) {
    Bytes file;
    cv::imencode(".jpg", SmoothPicture(CV_8UC1), file, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
    ColourImage image;
    ASSERT_TRUE(DecodeJpeg(file, kLimit_px, image).ok());
    // The last scan again and again, before the end mark.
    const Bytes mark{0xff, 0xda};
    const auto last = std::find_end(file.begin(), file.end(), mark.begin(), mark.end());
    const Bytes scan(last, file.end() - 2);
    for (int i = 0; i < 2000; ++i) file.insert(file.end() - 2, scan.begin(), scan.end());
    EXPECT_EQ(DecodeJpeg(file, kLimit_px, image).message(),
              "has more than 100 scans; save it again");
}

TEST(JpegDecoder, SurvivesRandomDamage) {
    const Bytes file = MakeJpeg(CV_8UC3);
    std::mt19937 random(5);
    ColourImage image;
    int refused = 0;
    for (int round = 0; round < 300; ++round) {
        Bytes broken = file;
        for (int i = 0; i < 5; ++i)
            broken[random() % broken.size()] = static_cast<std::uint8_t>(random());
        refused += !DecodeJpeg(broken, 1000, image).ok();
    }
    EXPECT_GT(refused, 50);
}

TEST(JpegDecoder, RefusesLongSidesBeforeDecoding) {
    ColourImage image;
    EXPECT_EQ(DecodeJpeg(MakeJpeg(CV_8UC3), 74, image).message(),
              "75 x 53 pixels; at most 74 per side are supported");
    EXPECT_TRUE(image.empty());
}

}  // namespace
}  // namespace tessera
