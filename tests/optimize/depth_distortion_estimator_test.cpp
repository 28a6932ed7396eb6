#include "optimize/depth_distortion_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optimize/distorted_room.h"

namespace tessera {
namespace {

using painted_room::DistortedView;
using painted_room::ErrorAt;
using painted_room::kCamera;
using painted_room::View;

constexpr int kViews = 40;

TEST(DepthDistortionEstimator, FindsTheErrorsButForTheirMean) {
    DepthDistortionEstimator estimator(kCamera);
    for (int i = 0; i < kViews; ++i) estimator.Add(DistortedView(i));
    const auto estimate = estimator.Estimate();
    ASSERT_TRUE(estimate);
    EXPECT_TRUE(estimate->shown());
    const DepthDistortion& found = estimate->found;
    ASSERT_TRUE(found.IsValid());
    const auto node = [&](int column, int row) {
        return static_cast<double>(
            found.per_m[static_cast<std::size_t>(row * found.columns + column)]);
    };
    const auto truth = [&](int column, int row) {
        return ErrorAt((column + 0.5) * kCamera.width / found.columns - 0.5,
                       (row + 0.5) * kCamera.height / found.rows - 0.5);
    };
    double offset = 0;
    int count = 0;
    for (int row = 1; row < found.rows - 1; ++row)
        for (int column = 1; column < found.columns - 1; ++column, ++count)
            offset += node(column, row) - truth(column, row);
    offset /= count;
    double square = 0;
    for (int row = 1; row < found.rows - 1; ++row)
        for (int column = 1; column < found.columns - 1; ++column)
            square += std::pow(node(column, row) - truth(column, row) - offset, 2);
    EXPECT_LT(std::sqrt(square / count), 0.001);  // the errors' own: 0.003
    EXPECT_LT(std::abs(offset), 0.002);
}

TEST(DepthDistortionEstimator, FindsNoneWhereThereIsNone) {
    DepthDistortionEstimator estimator(kCamera);
    for (int i = 0; i < kViews; ++i) estimator.Add(View(i, 0));
    const auto estimate = estimator.Estimate();
    ASSERT_TRUE(estimate);
    EXPECT_LT(estimate->rms_per_m, 0.0006);
    EXPECT_FALSE(estimate->shown());
}

// Shrinking all distances would make noise smaller, too; it must not look like an error.
TEST(DepthDistortionEstimator, FindsNoneInNoise) {
    constexpr double kNoise_per_m = 0.004;
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, kNoise_per_m);
    DepthDistortionEstimator estimator(kCamera);
    for (int i = 0; i < kViews; ++i) {
        Frame frame = View(i, 0);
        for (int v = 0; v < kCamera.height; ++v)
            for (int u = 0; u < kCamera.width; ++u) {
                float& z = frame.depth_m(u, v);
                z = static_cast<float>(1 / (1 / z + noise(random)));
            }
        estimator.Add(frame);
    }
    const auto estimate = estimator.Estimate();
    ASSERT_TRUE(estimate);
    EXPECT_LT(estimate->rms_per_m, 0.0006);
    EXPECT_FALSE(estimate->shown());
    EXPECT_GT(estimate->noise_per_m, 0.0004);  // of means over a few pixels
    EXPECT_LT(estimate->noise_per_m, 0.004);
}

TEST(DepthDistortionEstimator, IsShownBeyondItsDeviationAndTheNoise) {
    DepthDistortionEstimate estimate;
    const auto shown = [&](double rms_per_m, double sigma_per_m, double noise_per_m) {
        estimate.rms_per_m = rms_per_m;
        estimate.sigma_per_m = sigma_per_m;
        estimate.noise_per_m = noise_per_m;
        return estimate.shown();
    };
    EXPECT_TRUE(shown(0.0031, 0.001, 0.0015));
    EXPECT_FALSE(shown(0.0029, 0.001, 0.0015));
    EXPECT_TRUE(shown(0.0041, 0.001, 0.002));
    EXPECT_FALSE(shown(0.0039, 0.001, 0.002));
    EXPECT_TRUE(shown(0.0011, 0, 0));
    EXPECT_FALSE(shown(0.0009, 0, 0));
}

// Two parts of the same views have twice the pairs of one. Compared with each other they would have
// four times as many.
TEST(DepthDistortionEstimator, ComparesOnlyWithinAPart) {
    constexpr int kViewsOfPart = 8;
    DepthDistortionEstimator one(kCamera), two(kCamera);
    for (int part = 0; part < 2; ++part) {
        two.StartPart();
        for (int i = 0; i < kViewsOfPart; ++i) {
            two.Add(DistortedView(i));
            if (part == 0) one.Add(DistortedView(i));
        }
    }
    const auto of_one = one.Estimate(), of_two = two.Estimate();
    ASSERT_TRUE(of_one && of_two);
    EXPECT_EQ(of_two->pairs, 2 * of_one->pairs);
}

TEST(DepthDistortionEstimator, FindsTheErrorsFromShortParts) {
    DepthDistortionEstimator estimator(kCamera);
    for (const int first : {0, 20}) {
        estimator.StartPart();
        for (int i = first; i < first + 12; ++i) estimator.Add(DistortedView(i));
    }
    const auto estimate = estimator.Estimate();
    ASSERT_TRUE(estimate);
    EXPECT_TRUE(estimate->shown());
}

TEST(DepthDistortionEstimator, SaysNothingWithoutMotion) {
    DepthDistortionEstimator estimator(kCamera);
    EXPECT_FALSE(estimator.Estimate());
    for (int i = 0; i < 12; ++i) estimator.Add(DistortedView(3));
    EXPECT_FALSE(estimator.Estimate());
}

}  // namespace
}  // namespace tessera
