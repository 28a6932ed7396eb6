#include "semantics/label_picture.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

constexpr int kWidth = 200, kHeight = 150;  // room for names beside what is looked at
constexpr Rgb8 kCupColour{1, 200, 3}, kBookColour{4, 5, 220}, kScene{90, 80, 70}, kMap{20, 30, 40};

// A cup on the left, a book on the right, drawn where nothing overlaps.
class LabelPictureTest : public ::testing::Test {
  protected:
    LabelPictureTest() {
        LabelConfig config;
        config.classes = "cup=#01c803 book=#0405dc";
        classes = LabelClasses::Make(config, {}).value();
        detections[0].class_id = 2;
        detections[0].probability = 0.9f;
        detections[0].box = {120, 60, 180, 130};
        detections[1].class_id = 1;
        detections[1].probability = 0.8f;
        detections[1].box = {20, 60, 80, 130};
        objects.detection = Image<std::uint8_t>(kWidth, kHeight, 0);
        objects.detection(150, 100) = 1;
        objects.detection(50, 100) = 2;
        objects.detection(60, 100) = LabelImage::kBesideObjects;
        predicted(40, 120) = {1, 7};
    }
    ColourImage Picture() const {
        return LabelPicture({colour, detections, objects, map, predicted}, classes);
    }

    LabelClasses classes;
    ColourImage colour{kWidth, kHeight, kScene}, map{kWidth, kHeight, kMap};
    std::vector<Detection> detections{2};
    LabelImage objects;
    Image<VertexLabel> predicted{kWidth, kHeight};
};

TEST_F(LabelPictureTest, ShowsBoxesAndObjectsInTheColoursOfTheirClasses) {
    const ColourImage picture = Picture();
    ASSERT_EQ(picture.width(), 2 * kWidth);
    ASSERT_EQ(picture.height(), 2 * kHeight);
    EXPECT_EQ(picture(120, 100), kBookColour);  // left edges of the boxes
    EXPECT_EQ(picture(20, 100), kCupColour);
    EXPECT_EQ(picture(150, 100), kScene);
    EXPECT_EQ(picture(kWidth + 150, 100), kBookColour);
    EXPECT_EQ(picture(kWidth + 50, 100), kCupColour);
    const Rgb8 beside = picture(kWidth + 60, 100);
    EXPECT_TRUE(beside.r == beside.g && beside.g == beside.b && beside.r > 0);
    EXPECT_EQ(picture(kWidth + 70, 100), Rgb8());
    EXPECT_EQ(picture(100, kHeight + 100), kMap);
    EXPECT_EQ(picture(kWidth + 40, kHeight + 120), kCupColour);
    EXPECT_EQ(picture(kWidth + 150, kHeight + 100), Rgb8());  // nothing is predicted there
}

// The plate above an object has the colour of its class.
TEST_F(LabelPictureTest, NamesWhatItShows) {
    const auto plates = [](const ColourImage& picture, const Rgb8& of, int x0, int y0) {
        int pixels = 0;
        for (int y = y0; y < y0 + kHeight; ++y)
            for (int x = x0; x < x0 + kWidth; ++x) pixels += picture(x, y) == of;
        return pixels;
    };
    const ColourImage picture = Picture();
    EXPECT_GT(plates(picture, kCupColour, kWidth, kHeight), 400);
    EXPECT_EQ(plates(picture, kBookColour, kWidth, kHeight), 0);
    predicted(40, 120) = {2, 7};
    EXPECT_GT(plates(Picture(), kBookColour, kWidth, kHeight), 400);
}

TEST_F(LabelPictureTest, TakesFramesWithoutColourAndBoxesBeyondTheImage) {
    colour = {};
    detections[0].box = {-3e30f, -50, 5000, 1e20f};
    const ColourImage picture = Picture();
    EXPECT_EQ(picture.width(), 2 * kWidth);
    EXPECT_EQ(picture(110, 100), Rgb8());
}

}  // namespace
}  // namespace tessera
