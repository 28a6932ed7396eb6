// A segmentation network with the outputs of YOLOv8-seg, made up here, through OpenCV and down to
// the frame's mask. No trained one is at hand.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "semantics/dnn_detector.h"
#include "semantics/made_up_network.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

constexpr int kInput = 64, kCells = 64 + 16 + 4, kSide = kInput / 4, kMasks = 32, kClasses = 2;
constexpr int kRows = 4 + kClasses + kMasks;

struct Network {
    std::vector<float> boxes;  // kRows x kCells: the boxes output, the same for every image
    // kMasks x 3 x 4 x 4: prototype m in a cell is the sum of these times the cell's pixels.
    std::vector<float> weights;

    Network() : boxes(kRows * kCells), weights(kMasks * 3 * 16) {
        std::mt19937 random(3);
        std::normal_distribution<float> normal;
        for (float& w : weights) w = normal(random);
        // Centre (30.5, 22), size 29 x 24, class 1 with probability 0.75.
        const float column[] = {30.5f, 22, 29, 24, 0.1f, 0.75f};
        for (int row = 0; row < kRows; ++row) At(row) = row < 6 ? column[row] : normal(random);
    }
    float& At(int row) { return boxes[static_cast<std::size_t>(row * kCells + 17)]; }

    std::string Onnx() const {
        const int count = kRows * kCells;
        const std::vector<float> none(static_cast<std::size_t>(3 * count), 0.0f);
        const std::string constants =
            Field(5, OnnxTensor<float>("w", {kMasks, 3, 4, 4}, weights)) +
            Field(5, OnnxTensor<float>("zero", {count, 3, 1, 1}, none)) +
            Field(5, OnnxTensor<float>("bias", {count}, boxes)) +
            Field(5, OnnxTensor<std::int64_t>("shape", {3}, {1, kRows, kCells}));
        const std::string nodes =
            OnnxNode("GlobalAveragePool", {"images"}, "mean") +
            OnnxNode("Conv", {"mean", "zero", "bias"}, "flat",
                     OnnxIntegers("kernel_shape", {1, 1}) + OnnxIntegers("strides", {1, 1})) +
            OnnxNode("Reshape", {"flat", "shape"}, "output0") +
            OnnxNode("Conv", {"images", "w"}, "output1",
                     OnnxIntegers("kernel_shape", {4, 4}) + OnnxIntegers("strides", {4, 4}));
        return OnnxModel(nodes, constants, {OnnxValue("images", {1, 3, kInput, kInput})},
                         {OnnxValue("output0", {1, kRows, kCells}),
                          OnnxValue("output1", {1, kMasks, kSide, kSide})});
    }

    // coefficients * prototypes of a cell, from the pixels.
    double Logit(const ColourImage& image, int column, int row) {
        double sum = 0;
        for (int m = 0; m < kMasks; ++m)
            for (int c = 0; c < 3; ++c)
                for (int y = 0; y < 4; ++y)
                    for (int x = 0; x < 4; ++x) {
                        const Rgb8& pixel = image(4 * column + x, 4 * row + y);
                        const double value = c == 0 ? pixel.r : (c == 1 ? pixel.g : pixel.b);
                        sum += At(6 + m) * value / 255 *
                               weights[static_cast<std::size_t>(((m * 3 + c) * 4 + y) * 4 + x)];
                    }
        return sum;
    }
};

TEST(SegmentationNetwork, MaskOfTheFramesPixels) {
    if (!HasDnn()) GTEST_SKIP() << "this build has no networks: install libopencv-dnn-dev";
    TempFolder folder;
    Network network;
    std::ofstream(folder / "seg.onnx", std::ios::binary) << network.Onnx();
    std::ofstream(folder / "names.txt") << "cup\ncook book\n";
    LabelConfig config;
    config.input_px = kInput;
    config.names = folder / "names.txt";
    auto detector = OpenDnnDetector(folder / "seg.onnx", config);
    ASSERT_TRUE(detector.ok()) << detector.message();
    Frame frame;
    frame.colour.Resize(kInput, kInput);
    std::mt19937 random(5);
    for (int y = 0; y < kInput; ++y)
        for (int x = 0; x < kInput; ++x)
            frame.colour(x, y) = {static_cast<std::uint8_t>(random()),
                                  static_cast<std::uint8_t>(random()),
                                  static_cast<std::uint8_t>(random())};
    const auto found = detector.value()->Detect(frame);
    ASSERT_TRUE(found.ok()) << found.message();
    ASSERT_EQ(found.value().size(), 1u);
    const Detection& book = found.value()[0];
    EXPECT_EQ(book.name, "cook book");
    EXPECT_FLOAT_EQ(book.probability, 0.75f);
    // Edges 16 to 45 and 10 to 34: whole pixels, 29 x 24 of them.
    EXPECT_EQ(book.box, (DetectionBox{16, 10, 44, 33}));
    const PixelBox pixels = PixelsOf(book.box, kInput, kInput);
    EXPECT_EQ(pixels.width(), 29);
    EXPECT_EQ(pixels.height(), 24);
    ASSERT_EQ(book.mask.width(), pixels.width());
    ASSERT_EQ(book.mask.height(), pixels.height());
    int inside = 0;
    for (int y = pixels.y_begin; y < pixels.y_end; ++y)
        for (int x = pixels.x_begin; x < pixels.x_end; ++x) {
            const double u = (x + 0.5) / 4 - 0.5, v = (y + 0.5) / 4 - 0.5;
            const int column = static_cast<int>(u), row = static_cast<int>(v);
            const double right = u - column, below = v - row;
            const double logit =
                (1 - below) * ((1 - right) * network.Logit(frame.colour, column, row) +
                               right * network.Logit(frame.colour, column + 1, row)) +
                below * ((1 - right) * network.Logit(frame.colour, column, row + 1) +
                         right * network.Logit(frame.colour, column + 1, row + 1));
            const bool is = 1 / (1 + std::exp(-logit)) > 0.5;
            EXPECT_EQ(book.mask(x - pixels.x_begin, y - pixels.y_begin) != 0, is) << x << " " << y;
            inside += is;
        }
    EXPECT_GT(inside, 100);
    EXPECT_LT(inside, 600);
}

}  // namespace
}  // namespace tessera
