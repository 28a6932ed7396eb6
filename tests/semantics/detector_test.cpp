#include "semantics/detector.h"

#include <gtest/gtest.h>

#include <limits>

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
    FilterWanted(classes, 0.5, detections);
    ASSERT_EQ(detections.size(), 2u);
    EXPECT_EQ(detections[0].class_id, 1);
    EXPECT_EQ(detections[1].class_id, 5);
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
