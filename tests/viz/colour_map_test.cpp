#include "viz/colour_map.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(ColourMap, EndsAndMiddle) {
    EXPECT_EQ(DivergingColour(0), (Rgb8{245, 245, 245}));
    EXPECT_GT(DivergingColour(-1).r, DivergingColour(-1).b);
    EXPECT_GT(DivergingColour(1).b, DivergingColour(1).r);
    EXPECT_EQ(DivergingColour(-7), DivergingColour(-1));
    EXPECT_EQ(SequentialColour(3), SequentialColour(1));
    EXPECT_GT(SequentialColour(0).r, SequentialColour(0).b);
    EXPECT_GT(SequentialColour(1).b, SequentialColour(1).r);
}

TEST(ColourMap, ShrinkingTakesTheMean) {
    ColourImage image(5, 4, Rgb8{10, 20, 30});
    image(0, 0) = {50, 20, 30};
    const ColourImage small = ShrinkColour(image, 2);
    ASSERT_EQ(small.width(), 2);
    ASSERT_EQ(small.height(), 2);
    EXPECT_EQ(small(0, 0), (Rgb8{20, 20, 30}));
    EXPECT_EQ(small(1, 1), (Rgb8{10, 20, 30}));
}

TEST(ColourMap, DepthWithoutMeasurementHasNoColour) {
    DepthImage depth(4, 2, 2.0f);
    depth(2, 0) = 0;
    const ColourImage colours = DepthColours(depth, 4, 2);
    ASSERT_EQ(colours.width(), 2);
    EXPECT_EQ(colours(1, 0), kNothingShown);
    EXPECT_EQ(colours(0, 0), SequentialColour(128.0f / 255));
}

TEST(ColourMap, ResidualComparesTheSameDirections) {
    const PinholeCamera camera{8, 6, 10, 10, 3.5, 2.5};
    PredictedView predicted;
    predicted.Resize({4, 3, 5, 5, 1.5, 1}, Eigen::Isometry3d::Identity());
    predicted.SetNothing();
    std::fill_n(predicted.depth_m.data(), predicted.depth_m.size(), 2.0f);
    DepthImage measured(8, 6, 2.0f);
    measured(5, 3) = 1.5f;  // nearest to (4.5, 2.5), the ray of the small view's (2, 1)
    measured(0, 0) = 0;
    predicted.depth_m(3, 2) = 0;
    const ColourImage colours = ResidualColours(measured, camera, predicted, 0.04f);
    EXPECT_EQ(colours(2, 1), DivergingColour(-1));          // in front of the map
    EXPECT_EQ(colours(1, 1), DivergingColour(1.0f / 255));  // equal, within one step
    EXPECT_EQ(colours(3, 2), kNothingShown);
}

}  // namespace
}  // namespace tessera
