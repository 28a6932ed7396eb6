#include "io/image_decoder.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "io/temporary_folder.h"

namespace tessera {
namespace {

TEST(ImageDecoder, KeepsItsStorageFromImageToImage) {
    TemporaryFolder folder;
    folder.WriteColour("colour.png", 40, 30, {1, 2, 3});
    folder.WriteDepth("depth.png", 40, 30, 1234);
    ImageDecoder decoder;
    ColourImage colour;
    Image<std::uint16_t> depth;
    const Rgb8* colour_pixels = nullptr;
    const std::uint16_t* depth_pixels = nullptr;
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(decoder.ReadColour(folder.Path("colour.png"), colour).ok());
        ASSERT_TRUE(decoder.ReadDepth(folder.Path("depth.png"), depth).ok());
        EXPECT_EQ(colour, ColourImage(40, 30, {1, 2, 3}));
        EXPECT_EQ(depth, Image<std::uint16_t>(40, 30, 1234));
        if (i > 0) {
            EXPECT_EQ(colour.data(), colour_pixels);
            EXPECT_EQ(depth.data(), depth_pixels);
        }
        colour_pixels = colour.data();
        depth_pixels = depth.data();
    }
}

TEST(ImageDecoder, LeavesOtherFormatsToOpenCv) {
    TemporaryFolder folder;
    ASSERT_TRUE(
        cv::imwrite(folder.Path("colour.ppm"), cv::Mat(20, 30, CV_8UC3, cv::Scalar(3, 2, 1))));
    ASSERT_TRUE(
        cv::imwrite(folder.Path("depth.pgm"), cv::Mat(20, 30, CV_16UC1, cv::Scalar(40000))));
    ASSERT_TRUE(cv::imwrite(folder.Path("bits.png"), cv::Mat(20, 30, CV_8UC1, cv::Scalar(255)),
                            {cv::IMWRITE_PNG_BILEVEL, 1}));
    ImageDecoder decoder;
    ColourImage colour;
    Image<std::uint16_t> depth;
    ASSERT_TRUE(decoder.ReadColour(folder.Path("colour.ppm"), colour).ok());
    EXPECT_EQ(colour, ColourImage(30, 20, {1, 2, 3}));
    ASSERT_TRUE(decoder.ReadColour(folder.Path("bits.png"), colour).ok());
    EXPECT_EQ(colour, ColourImage(30, 20, {255, 255, 255}));
    ASSERT_TRUE(decoder.ReadDepth(folder.Path("depth.pgm"), depth).ok());
    EXPECT_EQ(depth, Image<std::uint16_t>(30, 20, 40000));
}

TEST(ImageDecoder, RefusesDepthOfTheWrongKind) {
    TemporaryFolder folder;
    ASSERT_TRUE(WriteGreyImage(folder.Path("grey.png"), Image<std::uint8_t>(20, 20)).ok());
    folder.WriteColour("colour.png", 20, 20, {});
    folder.WriteColour("colour.jpg", 20, 20, {});
    ImageDecoder decoder;
    Image<std::uint16_t> depth;
    const std::string needs = "; depth needs 16 bits and 1 channel";
    EXPECT_EQ(decoder.ReadDepth(folder.Path("grey.png"), depth).message(),
              folder.Path("grey.png") + ": has 8 bits and 1 channel" + needs);
    EXPECT_EQ(decoder.ReadDepth(folder.Path("colour.png"), depth).message(),
              folder.Path("colour.png") + ": has 8 bits and 3 channels" + needs);
    EXPECT_EQ(decoder.ReadDepth(folder.Path("colour.jpg"), depth).message(),
              folder.Path("colour.jpg") + ": has 8 bits and 3 channels" + needs);
}

TEST(ImageDecoder, NamesTheFileThatIsNoImage) {
    TemporaryFolder folder;
    folder.WriteText("empty.png", "");
    folder.WriteText("text.png", "this is not an image");
    folder.WriteDepth("depth.png", 64, 48, 777);
    const std::string whole = ReadText(folder.Path("depth.png"));
    folder.WriteText("cut.png", whole.substr(0, whole.size() / 2));
    ImageDecoder decoder;
    ColourImage colour;
    Image<std::uint16_t> depth;
    EXPECT_EQ(decoder.ReadDepth(folder.Path("empty.png"), depth).message(),
              folder.Path("empty.png") + ": is empty");
    EXPECT_EQ(decoder.ReadColour(folder.Path("text.png"), colour).message(),
              folder.Path("text.png") +
                  ": is not an image, or is truncated or damaged (read are PNG, JPEG, PNM, BMP and "
                  "TIFF)");
    EXPECT_EQ(
        decoder.ReadDepth(folder.Path("cut.png"), depth).message(),
        folder.Path("cut.png") + ": is truncated or damaged: too little data for 64 x 48 pixels");
    EXPECT_EQ(decoder.ReadDepth(folder.Path("absent.png"), depth).message(),
              folder.Path("absent.png") + ": no such file");
}

TEST(ImageDecoder, RefusesLongSidesFromTheHeader) {
    TemporaryFolder folder;
    ASSERT_TRUE(cv::imwrite(folder.Path("long.png"), cv::Mat(1, 8193, CV_16UC1, cv::Scalar(1))));
    Image<std::uint16_t> depth;
    EXPECT_EQ(ImageDecoder().ReadDepth(folder.Path("long.png"), depth).message(),
              folder.Path("long.png") + ": 8193 x 1 pixels; at most 8192 per side are supported");
    EXPECT_TRUE(depth.empty());
}

}  // namespace
}  // namespace tessera
