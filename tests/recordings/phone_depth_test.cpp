#include "recordings/phone_depth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/temporary_folder.h"
#include "recordings/recorded_stamps.h"

namespace tessera {
namespace {

const PinholeCamera kPhoneColour{
    .width = 1920, .height = 1440, .fx = 1450, .fy = 1460, .cx = 955.5, .cy = 722.25};

using PhoneDepthImage = Image<std::uint16_t>;

PhoneDepthImage PhoneRamp(int width, int height) {
    PhoneDepthImage depth(width, height);
    for (std::size_t i = 0; i < depth.size(); ++i)
        depth.data()[i] = static_cast<std::uint16_t>(1000 + i);
    return depth;
}

TEST(ScaledTo, TheBordersAndEveryPointStayWhereTheyAre) {
    const PinholeCamera small = ScaledTo(kPhoneColour, 256, 192);
    EXPECT_EQ(small.width, 256);
    EXPECT_EQ(small.height, 192);
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.3, -0.2, 1.7), Eigen::Vector3d(-1, 1, 2)}) {
        // Measured from the image's border, not from the first pixel's centre.
        const Eigen::Vector2d full = kPhoneColour.Project(p).array() + 0.5;
        const Eigen::Vector2d scaled = small.Project(p).array() + 0.5;
        EXPECT_NEAR(scaled.x() / 256, full.x() / 1920, 1e-12);
        EXPECT_NEAR(scaled.y() / 192, full.y() / 1440, 1e-12);
    }
    const PinholeCamera back = ScaledTo(small, 1920, 1440);
    EXPECT_NEAR(back.fx, kPhoneColour.fx, 1e-9);
    EXPECT_NEAR(back.cx, kPhoneColour.cx, 1e-9);
    EXPECT_NEAR(back.cy, kPhoneColour.cy, 1e-9);
    EXPECT_EQ(ScaledTo(kPhoneColour, 1920, 1440), kPhoneColour);
}

TEST(PhoneCameras, DepthSeesWhatColourSees) {
    RecordingInfo info;
    ASSERT_TRUE(SetPhoneCameras(kPhoneColour, {256, 192}, info).ok());
    EXPECT_EQ(info.colour_camera.pinhole, kPhoneColour);
    EXPECT_EQ(info.depth_camera.pinhole, ScaledTo(kPhoneColour, 256, 192));
    EXPECT_EQ(info.depth_camera.depth_scale, 1000);
    EXPECT_TRUE(info.T_colour_depth.matrix().isIdentity(0));
    const Status turned = SetPhoneCameras(kPhoneColour, {192, 256}, info);
    EXPECT_FALSE(turned.ok());
    EXPECT_NE(turned.message().find("192 x 256, another shape"), std::string::npos);
}

TEST(PhoneConfidence, OnlyDepthBelowTheLeastIsRemoved) {
    Image<std::uint8_t> sure(4, 3, 2);
    ColourImage grey(4, 3, {2, 2, 2});
    sure(1, 0) = 0;
    sure(3, 2) = 1;
    grey(1, 0) = {0, 0, 0};
    grey(3, 2) = {1, 1, 1};
    for (const int least : {0, 1, 2}) {
        PhoneDepthImage expected = PhoneRamp(4, 3);
        if (least > 0) expected(1, 0) = 0;
        if (least > 1) expected(3, 2) = 0;
        PhoneDepthImage depth = PhoneRamp(4, 3);
        ASSERT_TRUE(RemoveUnsure(sure, least, depth).ok());
        EXPECT_EQ(depth, expected);
        depth = PhoneRamp(4, 3);
        ASSERT_TRUE(RemoveUnsure(grey, least, depth).ok());
        EXPECT_EQ(depth, expected);
    }
    PhoneDepthImage other = PhoneRamp(3, 4);
    EXPECT_FALSE(RemoveUnsure(sure, 1, other).ok());
    EXPECT_EQ(other, PhoneRamp(3, 4));
}

TEST(NumberedFiles, AreSortedByNumberAndOthersPassedOver) {
    const TemporaryFolder folder;
    for (const char* name : {"d/10.png", "d/9.png", "d/000011.png", "d/11.png", "d/12.jpg",
                             "d/13.Clean.png", "d/a.png", "d/-1.png", "d/14png", "d/15.png.part",
                             "d/99999999999999999999999.png", "d/16", "d/.png"})
        folder.WriteText(name, "");
    const std::vector<NumberedFile> files = NumberedFiles(folder.Path("d"), "png");
    EXPECT_EQ(files, (std::vector<NumberedFile>{{9, "9.png"}, {10, "10.png"}, {11, "000011.png"}}));
    EXPECT_EQ(NameOfNumber("d", files, 11), "d/000011.png");
    EXPECT_EQ(NameOfNumber("d", files, 12), "");
    EXPECT_TRUE(NumberedFiles(folder.Path("none"), "png").empty());
    EXPECT_TRUE(NumberedFiles(folder.Path("d/9.png"), "png").empty());
}

TEST(PhoneImages, ErrorsNameTheFileWithinTheFolder) {
    const TemporaryFolder folder;
    folder.WriteDepth("depth/1.png", 32, 24, 1000);
    folder.WriteDepth("depth/2.png", 32, 24, 1000);
    folder.WriteText("depth/3.png", "no image");
    ASSERT_TRUE(WriteGreyImage(folder.Path("small.png"), Image<std::uint8_t>(16, 12, 2)).ok());
    PhoneImages images(folder.path());
    PhoneDepthImage depth;
    EXPECT_TRUE(images.ReadDepth({1, "depth/1.png", ""}, depth).ok());
    EXPECT_EQ(depth, PhoneDepthImage(32, 24, 1000));
    EXPECT_EQ(images.ReadDepth({1, "depth/1.png", "small.png"}, depth).message(),
              "small.png: confidence has 16 x 12 pixels, but depth has 32 x 24");
    EXPECT_TRUE(images.ReadDepth({3, "depth/3.png", ""}, depth)
                    .message()
                    .starts_with("depth/3.png: is not an image"));
    EXPECT_EQ(images.ReadDepth({4, "depth/4.png", ""}, depth).message(),
              "depth/4.png: no such file");
    const auto size = images.FirstSize({"depth/3.png", "depth/2.png"});
    ASSERT_TRUE(size.ok());
    EXPECT_EQ(size.value(), (ImageSize{32, 24}));
    EXPECT_TRUE(images.FirstSize({"depth/3.png", "x.png"}).message().starts_with("depth/3.png"));
}

TEST(RecordedStamps, RateAndOrderComeFromTheDepthStamps) {
    std::vector<RecordedPair> pairs = EvenlyStamped(5, 20);
    EXPECT_EQ(pairs[3].depth_stamp_s, 0.15);
    EXPECT_EQ(pairs[3].colour_stamp_s, 0.15);
    EXPECT_TRUE(DepthStampsIncrease(pairs));
    EXPECT_NEAR(MedianFps(pairs, 1), 20, 1e-9);
    pairs[4].depth_stamp_s = 100;  // a pause
    EXPECT_NEAR(MedianFps(pairs, 1), 20, 1e-9);
    pairs[2].depth_stamp_s = pairs[1].depth_stamp_s;
    EXPECT_FALSE(DepthStampsIncrease(pairs));
    pairs[2].depth_stamp_s = std::nan("");
    EXPECT_FALSE(DepthStampsIncrease(pairs));
    EXPECT_EQ(MedianFps(EvenlyStamped(1, 20), 7), 7);
}

}  // namespace
}  // namespace tessera
