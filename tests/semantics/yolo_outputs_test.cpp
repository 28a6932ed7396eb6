#include "semantics/yolo_outputs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tessera {
namespace {

// An input of 32 px gives 16 + 4 + 1 = 21 cells. Two classes.
constexpr int kInput = 32, kCells = 21;

struct Outputs {
    std::vector<std::vector<float>> values;
    std::vector<OutputArray> arrays;
    std::vector<float>& Add(std::vector<int> shape) {
        std::size_t size = 1;
        for (const int n : shape) size *= static_cast<std::size_t>(n);
        values.emplace_back(size, 0.0f);
        arrays.push_back({std::move(shape), nullptr});
        for (std::size_t i = 0; i < arrays.size(); ++i) arrays[i].data = values[i].data();
        return values.back();
    }
};

void ExpectOne(const std::vector<RawDetection>& found, int class_index, float probability,
               float x_min, float y_min, float x_max, float y_max) {
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].class_index, class_index);
    EXPECT_NEAR(found[0].probability, probability, 1e-6);
    EXPECT_NEAR(found[0].x_min, x_min, 1e-4);
    EXPECT_NEAR(found[0].y_min, y_min, 1e-4);
    EXPECT_NEAR(found[0].x_max, x_max, 1e-4);
    EXPECT_NEAR(found[0].y_max, y_max, 1e-4);
}

TEST(YoloOutputs, YoloxCountsInCells) {
    Outputs o;
    auto& v = o.Add({1, kCells, 7});
    // Cell (1, 0) of stride 16 is row 16 + 1: centre ((0.5 + 1) 16, (0.25 + 0) 16), size (16 e^0,
    // 16 e^log(0.5)).
    const float row[] = {0.5f, 0.25f, 0, std::log(0.5f), 0.8f, 0.1f, 0.9f};
    std::copy(std::begin(row), std::end(row), v.begin() + 17 * 7);
    const auto layout = RecogniseOutputs(o.arrays, kInput, ModelFamily::kAuto);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_EQ(layout.value().family, ModelFamily::kYolox);
    EXPECT_EQ(layout.value().classes, 2);
    ExpectOne(DecodeOutputs(layout.value(), o.arrays, 0.5f), 1, 0.72f, 16, 0, 32, 8);
    EXPECT_TRUE(DecodeOutputs(layout.value(), o.arrays, 0.73f).empty());
}

TEST(YoloOutputs, Yolov5CountsInPixels) {
    Outputs o;
    auto& v = o.Add({1, 3 * kCells, 7});
    const float row[] = {10, 12, 4, 6, 0.5f, 1, 0.2f};
    std::copy(std::begin(row), std::end(row), v.begin() + 40 * 7);
    const auto layout = RecogniseOutputs(o.arrays, kInput, ModelFamily::kAuto);
    ASSERT_TRUE(layout.ok());
    EXPECT_EQ(layout.value().family, ModelFamily::kYolov5);
    ExpectOne(DecodeOutputs(layout.value(), o.arrays, 0.3f), 0, 0.5f, 8, 9, 12, 15);
}

TEST(YoloOutputs, Yolov8ChannelsFirstWithMasks) {
    Outputs o;
    auto& v = o.Add({1, 4 + 2 + 32, kCells});
    const float column[] = {10, 12, 4, 6, 0.1f, 0.6f, 1.0f};  // the last is a mask coefficient
    for (int i = 0; i < 7; ++i) v[static_cast<std::size_t>(i * kCells + 5)] = column[i];
    auto& prototypes = o.Add({1, 32, 8, 8});
    std::fill_n(prototypes.begin(), 64, -1.0f);
    prototypes[3 * 8 + 2] = 1;  // input pixels x 8 to 12, y 12 to 16
    const auto layout = RecogniseOutputs(o.arrays, kInput, ModelFamily::kAuto);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_EQ(layout.value().family, ModelFamily::kYolov8);
    EXPECT_EQ(layout.value().classes, 2);
    const auto found = DecodeOutputs(layout.value(), o.arrays, 0.5f);
    ExpectOne(found, 1, 0.6f, 8, 9, 12, 15);
    const Image<std::uint8_t> mask =
        MaskOf(layout.value(), o.arrays, found[0], {8, 9, 13, 16}, 1, 1);
    EXPECT_EQ(mask.width(), 5);
    EXPECT_EQ(mask.height(), 7);
    EXPECT_EQ(mask(1, 4), 1);
    EXPECT_EQ(mask(4, 4), 0);
}

// The slow way: every pixel's product of 32 coefficients at the four cells around it.
bool InMask(const Outputs& o, const RawDetection& d, double x, double y) {
    const int side = o.arrays[1].shape[2];
    double logit = 0;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const auto weight = [side](double at, int cell) {
                at = std::min(std::max(at / 4, 0.5), side - 0.5);  // cell i's centre is i + 0.5
                return std::max(0.0, 1 - std::abs(at - cell - 0.5));
            };
            for (int m = 0; m < 32; ++m)
                logit += weight(x, column) * weight(y, row) *
                         d.mask_coefficients[static_cast<std::size_t>(m)] *
                         o.arrays[1].data[(m * side + row) * side + column];
        }
    return 1 / (1 + std::exp(-logit)) > 0.5;
}

TEST(YoloOutputs, MasksAsComputedSlowly) {
    Outputs o;
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    o.Add({1, 4 + 2 + 32, kCells});
    for (float& value : o.Add({1, 32, 8, 8})) value = normal(random);
    const auto layout = RecogniseOutputs(o.arrays, kInput, ModelFamily::kAuto);
    ASSERT_TRUE(layout.ok()) << layout.message();
    RawDetection detection;
    for (int m = 0; m < 32; ++m) detection.mask_coefficients.push_back(normal(random));
    // A frame of 80 x 60 pixels, up to its edges.
    const double scale = 0.4;
    int inside = 0;
    for (const PixelBox& box : {PixelBox{0, 0, 80, 60}, PixelBox{13, 7, 14, 30}}) {
        const auto mask = MaskOf(layout.value(), o.arrays, detection, box, scale, scale);
        for (int y = 0; y < box.height(); ++y)
            for (int x = 0; x < box.width(); ++x) {
                EXPECT_EQ(mask(x, y) != 0, InMask(o, detection, (x + box.x_begin + 0.5) * scale,
                                                  (y + box.y_begin + 0.5) * scale))
                    << x << " " << y;
                inside += mask(x, y);
            }
    }
    EXPECT_GT(inside, 1000);
    EXPECT_LT(inside, 4000);
    EXPECT_TRUE(MaskOf(layout.value(), o.arrays, detection, {}, scale, scale).empty());
}

TEST(YoloOutputs, DarknetIsRelative) {
    Outputs o;
    auto& v = o.Add({3, 7});
    o.Add({2, 7});
    const float row[] = {0.5f, 0.25f, 0.5f, 0.25f, 0.9f, 0.7f, 0};
    o.values[0] = std::vector<float>(21, 0.0f);
    std::copy(std::begin(row), std::end(row), o.values[0].begin() + 7);
    o.arrays[0].data = o.values[0].data();
    (void)v;
    const auto layout = RecogniseOutputs(o.arrays, kInput, ModelFamily::kAuto);
    ASSERT_TRUE(layout.ok());
    EXPECT_EQ(layout.value().family, ModelFamily::kDarknet);
    ExpectOne(DecodeOutputs(layout.value(), o.arrays, 0.5f), 0, 0.7f, 8, 4, 24, 12);
}

TEST(YoloOutputs, UnknownShapesAreListed) {
    Outputs o;
    o.Add({1, 1000});
    EXPECT_NE(RecogniseOutputs(o.arrays, kInput, ModelFamily::kAuto).message().find("YOLOX"),
              std::string::npos);
    Outputs yolox;
    yolox.Add({1, kCells, 7});
    EXPECT_NE(RecogniseOutputs(yolox.arrays, kInput, ModelFamily::kYolov8).message().find("1x21x7"),
              std::string::npos);
    EXPECT_FALSE(RecogniseOutputs({}, kInput, ModelFamily::kAuto).ok());
}

TEST(YoloOutputs, NumbersThatAreNone) {
    Outputs o;
    auto& v = o.Add({1, kCells, 7});
    const float nan = std::nanf("");
    const float rows[] = {0, 0, 100, 0, 1, 1, 0, nan, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, nan, 1, 0};
    std::copy(std::begin(rows), std::end(rows), v.begin());
    const auto layout = RecogniseOutputs(o.arrays, kInput, ModelFamily::kAuto);
    // e^100 cells wide: the box overflows.
    EXPECT_TRUE(DecodeOutputs(layout.value(), o.arrays, 0.5f).empty());
}

TEST(SuppressOverlaps, KeepsTheMostProbableOfAClass) {
    std::vector<RawDetection> d = {{0, 0.6f, 0, 0, 10, 10, {}},
                                   {0, 0.9f, 1, 0, 11, 10, {}},
                                   {1, 0.5f, 0, 0, 10, 10, {}},
                                   {0, 0.7f, 20, 0, 30, 10, {}}};
    SuppressOverlaps(0.45f, d);
    ASSERT_EQ(d.size(), 3u);
    EXPECT_FLOAT_EQ(d[0].probability, 0.9f);
    EXPECT_FLOAT_EQ(d[1].probability, 0.7f);
    EXPECT_EQ(d[2].class_index, 1);
}

}  // namespace
}  // namespace tessera
