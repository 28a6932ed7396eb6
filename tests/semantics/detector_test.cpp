#include "semantics/detector.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace tessera {
namespace {

TEST(PixelsOf, AnyNumbers) {
    const PixelBox box = PixelsOf({-5, 2.4f, 700, 3.6f}, 640, 480);
    EXPECT_EQ(box.x_begin, 0);
    EXPECT_EQ(box.x_end, 640);
    EXPECT_EQ(box.y_begin, 2);
    EXPECT_EQ(box.y_end, 5);
    EXPECT_TRUE(PixelsOf({700, 0, 800, 10}, 640, 480).empty());
    EXPECT_TRUE(PixelsOf({10, 10, 5, 5}, 640, 480).empty());
    const float nan = std::numeric_limits<float>::quiet_NaN(), huge = 1e30f;
    EXPECT_GE(PixelsOf({nan, nan, huge, huge}, 640, 480).x_begin, 0);
    EXPECT_LE(PixelsOf({-huge, -huge, huge, huge}, 640, 480).x_end, 640);
}

TEST(FilterWanted, ByClassAndProbabilityMostProbableFirst) {
    const LabelClasses classes = LabelClasses::Make({}, {}).value();
    std::vector<Detection> detections = {
        {"cup", 0, 0.5f, {}, {}},
        {"tv", 0, 0.9f, {}, {}},
        {"dog", 0, 0.9f, {}, {}},
        {"book", 0, 0.49f, {}, {}},
        {"cup", 0, std::numeric_limits<float>::quiet_NaN(), {}, {}}};
    FilterWanted(classes, 0.5, 0.45, detections);
    ASSERT_EQ(detections.size(), 2u);
    EXPECT_EQ(detections[0].class_id, 1);
    EXPECT_EQ(detections[1].class_id, 5);
}

// A network has a television and a laptop where there is one computer.
TEST(FilterWanted, OfTwoNamesOfOneClassTheMoreProbableStays) {
    LabelConfig config;
    config.classes = "computer cup";
    config.aliases = "tv=computer laptop=computer";
    const LabelClasses classes = LabelClasses::Make(config, {}).value();
    const auto names = [&](const DetectionBox& laptop, double overlap = 0.45) {
        std::vector<Detection> detections = {{"laptop", 0, 0.6f, laptop, {}},
                                             {"cup", 0, 0.7f, {0, 0, 99, 99}, {}},
                                             {"tv", 0, 0.8f, {0, 0, 99, 99}, {}}};
        FilterWanted(classes, 0.5, overlap, detections);
        std::string all;
        for (const Detection& d : detections) all += d.name + " ";
        return all;
    };
    EXPECT_EQ(names({0, 0, 99, 89}), "tv cup ");
    EXPECT_EQ(names({0, 0, 99, 45}), "tv cup ");
    EXPECT_EQ(names({0, 0, 99, 44}), "tv cup laptop ");  // an overlap of 0.45
    EXPECT_EQ(names({0, 0, 99, 89}, 0.9), "tv cup laptop ");
}

// True boxes of a stack of books overlap. A raw file has each book several times.
TEST(FilterWanted, OfOneNameOnlyNearlyTheSameBoxesAreOne) {
    const LabelClasses classes = LabelClasses::Make({}, {}).value();
    const auto count = [&](float bottom) {
        std::vector<Detection> detections = {{"book", 0, 0.9f, {0, 0, 99, 99}, {}},
                                             {"book", 0, 0.9f, {0, 0, 99, bottom}, {}}};
        FilterWanted(classes, 0.5, 0.45, detections);
        return detections.size();
    };
    EXPECT_EQ(count(66), 2u);
    EXPECT_EQ(count(79), 2u);
    EXPECT_EQ(count(80), 1u);
}

TEST(ExtractDynamic, LeavesTheRestInItsOrder) {
    const LabelClasses classes = LabelClasses::Make({}, {}).value();
    std::vector<Detection> detections = {{"cup", 0, 0.5f, {}, {}},
                                         {"person", 0, 0.9f, {}, {}},
                                         {"dog", 0, 0.9f, {}, {}},
                                         {"person", 0, 0.4f, {}, {}},
                                         {"book", 0, 0.1f, {}, {}}};
    const std::vector<Detection> dynamic = ExtractDynamic(classes, 0.5, detections);
    ASSERT_EQ(dynamic.size(), 1u);
    EXPECT_FLOAT_EQ(dynamic[0].probability, 0.9f);
    ASSERT_EQ(detections.size(), 3u);
    EXPECT_EQ(detections[1].name, "dog");
}

}  // namespace
}  // namespace tessera
