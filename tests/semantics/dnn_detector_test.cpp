// Tests of a published network on a real image, and of invalid files. The data is not part of the
// project: see README, "Data".
#include "semantics/dnn_detector.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/input_file.h"
#include "io/image_io.h"
#include "semantics/made_up_network.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

std::string SharedPath(const std::string& name) {
    const char* root = std::getenv("TESSERA_DATA");
    return (root ? std::string(root) + "/../" : std::string(TESSERA_SOURCE_DIR) + "/../shared/") +
           name;
}
const std::string kModel = SharedPath("models/yolox_nano.onnx");

class DnnDetectorTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!HasDnn()) GTEST_SKIP() << "this build has no networks: install libopencv-dnn-dev";
        if (!std::filesystem::exists(kModel))
            GTEST_SKIP() << kModel
                         << " is absent: YOLOX-nano as ONNX, from the YOLOX project's releases";
    }
    static void ExpectRefused(const std::string& path, const LabelConfig& config,
                              const std::string& named) {
        const auto detector = OpenDnnDetector(path, config);
        ASSERT_FALSE(detector.ok()) << path;
        EXPECT_NE(detector.message().find(named), std::string::npos) << detector.message();
        EXPECT_EQ(detector.message().find('\n'), std::string::npos) << detector.message();
    }
};

TEST_F(DnnDetectorTest, FindsTheDesksThings) {
    const std::string folder = SharedPath("data/tum_fr1_rpy/rgb");
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.push_back(entry.path().string());
    std::ranges::sort(files);
    auto detector = OpenDnnDetector(kModel, {});
    ASSERT_TRUE(detector.ok()) << detector.message();
    EXPECT_EQ(detector.value()->class_names().size(), 80u);
    Frame frame;
    frame.colour = ReadColourImage(files[20]).value();
    auto found = detector.value()->Detect(frame);
    ASSERT_TRUE(found.ok()) << found.message();
    const auto has = [&](const std::string& name) {
        return std::ranges::any_of(found.value(), [&](const Detection& d) {
            return d.name == name && d.probability > 0.5f;
        });
    };
    EXPECT_TRUE(has("tv"));
    EXPECT_TRUE(has("keyboard"));
    frame.colour = {};
    EXPECT_FALSE(detector.value()->Detect(frame).ok());
}

// An ONNX network with a single Relu, whose output has the shape of its input.
std::string ReluNetwork(int side) {
    return OnnxModel(OnnxNode("Relu", {"x"}, "y"), "", {OnnxValue("x", {1, 3, side, side})},
                     {OnnxValue("y", {1, 3, side, side})});
}

TEST(UnknownNetwork, IsOneLineWithItsShapes) {
    if (!HasDnn()) GTEST_SKIP() << "this build has no networks: install libopencv-dnn-dev";
    TempFolder folder;
    std::ofstream(folder / "relu.onnx", std::ios::binary) << ReluNetwork(64);
    LabelConfig config;
    config.input_px = 64;
    const auto detector = OpenDnnDetector(folder / "relu.onnx", config);
    ASSERT_FALSE(detector.ok());
    EXPECT_NE(detector.message().find("1x3x64x64"), std::string::npos) << detector.message();
    EXPECT_NE(detector.message().find("labels.family"), std::string::npos) << detector.message();
    EXPECT_EQ(detector.message().find('\n'), std::string::npos) << detector.message();
}

TEST_F(DnnDetectorTest, WhatIsNoNetworkIsOneLine) {
    TempFolder folder;
    const std::string model = ReadWholeFile(kModel, 1 << 28).value();
    std::ofstream(folder / "cut.onnx", std::ios::binary) << model.substr(0, model.size() / 2);
    std::ofstream(folder / "text.onnx") << "hello, this is no network at all\n";
    std::ofstream(folder / "empty.onnx");
    std::ofstream(folder / "a.cfg") << "[net]\nwidth=416\n";
    std::ofstream(folder / "names.txt") << "cat\ndog\n";
    ExpectRefused(folder / "none.onnx", {}, "none.onnx");
    ExpectRefused(folder / "cut.onnx", {}, "cut.onnx");
    ExpectRefused(folder / "text.onnx", {}, "text.onnx");
    ExpectRefused(folder / "empty.onnx", {}, "is empty");
    ExpectRefused(folder / "a.cfg", {}, "a.weights");
    LabelConfig config;
    config.names = folder / "names.txt";
    ExpectRefused(kModel, config, "has 80 classes");
    config = {};
    config.family = ModelFamily::kYolov8;
    ExpectRefused(kModel, config, "labels.family");
}

}  // namespace
}  // namespace tessera
