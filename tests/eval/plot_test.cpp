#include "eval/plot.h"

#include <gtest/gtest.h>

#include "eval/mesh_error.h"
#include "eval/test_trajectories.h"

namespace tessera {
namespace {

// Number of pixels in which blue dominates, as it does in the curve of the estimate.
int BluePixels(const ColourImage& image, int x0, int y0, int x1, int y1) {
    int count = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) count += image(x, y).b > image(x, y).r + 100;
    return count;
}

TEST(Plot, EachOfTheFourChartsHoldsTheCurve) {
    const auto reference = WindingPath(200);
    auto estimate = reference;
    for (StampedPose& pose : estimate) pose.T_world_camera(2, 3) += 0.1 * std::sin(pose.stamp_s);
    const ColourImage image = PlotAte(EvaluateAte(reference, estimate).value(), "a title");
    ASSERT_EQ(image.width(), 1280);
    ASSERT_EQ(image.height(), 960);
    for (const int x : {0, 640})
        for (const int y : {80, 520}) EXPECT_GT(BluePixels(image, x, y, x + 640, y + 440), 300);
    EXPECT_EQ(image(2, 2), (Rgb8{255, 255, 255}));
}

TEST(Plot, PathsWithoutExtentOrErrorAreDrawn) {
    const auto still = PosesAt({1, 2, 3, 4});
    EXPECT_EQ(PlotAte(EvaluateAte(still, still).value(), "").width(), 1280);
    std::vector<StampedPose> far = WindingPath(50);
    for (StampedPose& pose : far) pose.T_world_camera.translation() *= 1e5;
    EXPECT_EQ(PlotAte(EvaluateAte(far, far).value(), "").width(), 1280);
}

TEST(Plot, TheScaleRunsFromBlueToRed) {
    ColourImage image(400, 300, Rgb8{10, 20, 30});
    DrawErrorScale(0.01, image);
    ASSERT_EQ(image.width(), 400);
    EXPECT_GT(image(25, 255).b, 250);
    EXPECT_NEAR(image(25, 255).g, 255 * 4 * 0.015, 2);
    EXPECT_GT(image(122, 255).r, 250);
    EXPECT_NEAR(image(122, 255).g, 255 * 4 * 0.015, 2);
    EXPECT_EQ(image(390, 10), (Rgb8{10, 20, 30}));
}

}  // namespace
}  // namespace tessera
