#include "synth/sensor_model.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>

#include "synth/hash_random.h"

namespace tessera {
namespace {

const PinholeCamera kSensorCamera{160, 120, 131, 131, 79.5, 59.5};

RenderedView FilledView(float depth, float slope = 0, float grey = 128) {
    RenderedView view;
    view.depth_m.Resize(160, 120);
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x)
            view.depth_m(x, y) = depth + slope * static_cast<float>(x + y);
    view.cos_incidence = Image<float>(160, 120, 0.9f);
    view.colour = Image<RgbF>(160, 120, {grey, grey, grey});
    return view;
}

SensorModel::Config Kinect() {
    SensorModel::Config config;
    config.noise = NoiseModel::kKinect;
    return config;
}

TEST(SensorModel, NoneGivesTheTruth) {
    const SensorModel model({}, kSensorCamera, 1);
    const RenderedView view = FilledView(7.5f);
    DepthImage depth;
    ColourImage colour;
    model.SenseDepth(view, 0, depth);
    model.SenseColour(view, 0, 0.3, colour);
    EXPECT_EQ(depth, view.depth_m);
    EXPECT_EQ(colour, ColourImage(160, 120, {128, 128, 128}));
    EXPECT_EQ(model.exposure_s(), 0);
}

// sigma_z = z^2 / (f b) * sqrt(sigma_d^2 + step^2 / 12), on a slope, where the quantisation errors
// are uniformly distributed.
TEST(SensorModel, DepthNoiseGrowsWithTheSquareOfDepth) {
    const SensorModel::Config config = Kinect();
    const SensorModel model(config, kSensorCamera, 7);
    const double disparity_std =
        std::hypot(config.disparity_std_px, config.disparity_step_px / std::sqrt(12.0));
    for (const float z : {0.6f, 1.0f, 2.0f, 4.0f}) {
        const RenderedView view = FilledView(z, 2e-4f * z * z);
        double sum2 = 0, sum = 0;
        int count = 0;
        for (int frame = 0; frame < 40; ++frame) {
            DepthImage depth;
            model.SenseDepth(view, frame, depth);
            for (std::size_t i = 0; i < depth.size(); ++i) {
                if (depth.data()[i] == 0) continue;
                const double truth = view.depth_m.data()[i];
                const double error = (depth.data()[i] - truth) / (truth * truth);
                sum += error;
                sum2 += error * error;
                ++count;
            }
        }
        ASSERT_GT(count, 100000) << z;
        const double expected = disparity_std / (config.focal_px * config.baseline_m);
        EXPECT_NEAR(std::sqrt(sum2 / count), expected, 0.15 * expected) << z;
        EXPECT_LT(std::abs(sum / count), 0.15 * expected) << z;
    }
}

TEST(SensorModel, DisparityComesInSteps) {
    const SensorModel model(Kinect(), kSensorCamera, 7);
    DepthImage depth;
    model.SenseDepth(FilledView(1.5f, 1e-3f), 0, depth);
    int count = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        if (depth.data()[i] == 0) continue;
        const double steps = 580 * 0.075 / depth.data()[i] / 0.125;
        EXPECT_NEAR(steps, std::round(steps), 1e-4);
        ++count;
    }
    EXPECT_GT(count, 15000);
}

TEST(SensorModel, NoDepthTooNearTooFarOrTooFlat) {
    const SensorModel model(Kinect(), kSensorCamera, 7);
    const auto measured = [&](const RenderedView& view) {
        DepthImage depth;
        model.SenseDepth(view, 0, depth);
        int count = 0;
        for (std::size_t i = 0; i < depth.size(); ++i) count += depth.data()[i] > 0;
        return count;
    };
    EXPECT_EQ(measured(FilledView(0.40f)), 0);
    EXPECT_EQ(measured(FilledView(5.5f)), 0);
    EXPECT_EQ(measured(FilledView(1.0f)), 160 * 120);
    RenderedView flat = FilledView(1.0f);
    flat.cos_incidence = Image<float>(160, 120, 0.15f);
    EXPECT_EQ(measured(flat), 0);
    EXPECT_EQ(measured(FilledView(0.0f)), 0);  // nothing in view
}

TEST(SensorModel, TheProjectorsShadowFallsOnTheRightOfNearThings) {
    SensorModel::Config config = Kinect();
    config.edge_dropout = config.lateral_std_px = 0;
    const SensorModel model(config, kSensorCamera, 7);
    RenderedView view = FilledView(2.0f);
    for (int y = 0; y < 120; ++y)
        for (int x = 40; x < 60; ++x) view.depth_m(x, y) = 1.0f;
    DepthImage depth;
    model.SenseDepth(view, 0, depth);
    // Disparity between the two depths: f b (1 / 1 m - 1 / 2 m) = 131 * 0.075 / 2 = 4.9 px.
    for (int x = 60; x < 63; ++x) EXPECT_EQ(depth(x, 50), 0) << x;
    for (const int x : {30, 39, 40, 59, 66, 100}) EXPECT_GT(depth(x, 50), 0) << x;
}

TEST(SensorModel, ColourNoiseHasItsStrengthAndTheGainStaysInItsBounds) {
    SensorModel::Config config = Kinect();
    config.vignetting = config.exposure_drift = 0;
    config.colour_noise = 4;
    ColourImage colour;
    SensorModel(config, kSensorCamera, 5).SenseColour(FilledView(1, 0, 60), 3, 0, colour);
    double sum = 0, sum2 = 0;
    for (std::size_t i = 0; i < colour.size(); ++i) {
        sum += colour.data()[i].g;
        sum2 += colour.data()[i].g * colour.data()[i].g;
    }
    const double mean = sum / 19200, std = std::sqrt(sum2 / 19200 - mean * mean);
    EXPECT_NEAR(mean, 60, 0.15);
    const double wanted = 4 * (1 - 0.4 * 60 / 255);
    EXPECT_NEAR(std, std::hypot(wanted, 1 / std::sqrt(12.0)), 0.1);

    config.exposure_drift = 0.15;
    const SensorModel drifting(config, kSensorCamera, 5);
    double low = 2, high = 0;
    for (double t = 0; t < 60; t += 0.1) {
        low = std::min(low, drifting.Gain(t));
        high = std::max(high, drifting.Gain(t));
    }
    EXPECT_GE(low, 0.85);
    EXPECT_LE(high, 1.15);
    EXPECT_LT(low, 0.90);
    EXPECT_GT(high, 1.10);
}

TEST(SensorModel, IsAFunctionOfSeedAndFrameAlone) {
    const RenderedView view = FilledView(1.3f, 1e-4f);
    const auto sense = [&](std::uint64_t seed, std::int64_t frame, std::size_t threads) {
        tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        std::pair<DepthImage, ColourImage> images;
        const SensorModel model(Kinect(), kSensorCamera, seed);
        model.SenseDepth(view, frame, images.first);
        model.SenseColour(view, frame, 0.5, images.second);
        return images;
    };
    EXPECT_EQ(sense(1, 5, 1), sense(1, 5, 4));
    EXPECT_NE(sense(1, 5, 1).first, sense(1, 6, 1).first);
    EXPECT_NE(sense(1, 5, 1).first, sense(2, 5, 1).first);
    EXPECT_NE(sense(1, 5, 1).second, sense(2, 5, 1).second);
}

TEST(SmoothNoise, HasUnitVarianceAndItsReach) {
    double sum2 = 0, far = 0, near = 0;
    int count = 0;
    for (std::uint64_t key = 0; key < 400; ++key) {
        std::vector<float> row;
        SmoothNoise(MixBits(key), 6, 200).Row(static_cast<int>(key % 17), row);
        for (int x = 0; x < 150; ++x, ++count) {
            sum2 += row[x] * row[x];
            near += row[x] * row[x + 6];
            far += row[x] * row[x + 48];
        }
    }
    EXPECT_NEAR(sum2 / count, 1, 0.05);
    // White noise blurred with sigma has the correlation exp(-d^2 / (4 sigma^2)).
    EXPECT_NEAR(near / sum2, std::exp(-0.25), 0.05);
    EXPECT_NEAR(far / sum2, 0, 0.05);
}

}  // namespace
}  // namespace tessera
