// How far depths scatter, from images with a known scatter, and the band that follows from it.
#include "run/noise_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "run/depth_scatter.h"
#include "run/run.h"

namespace tessera {
namespace {

constexpr double kFarthest_m = 8;

// A slanted floor and a wall that meet, 1.2 to 4 m away, with a box before them and a hole; normal
// noise of inverse depth.
DepthImage NoisyCorner(int width, double sigma_per_m, unsigned seed = 1) {
    const int height = width * 3 / 4;
    DepthImage depth_m(width, height, 0.0f);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, sigma_per_m);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            double inverse = v < 0.5 ? 0.25 + 0.2 * u : 0.25 + 0.2 * u + 0.6 * (v - 0.5);
            if (u > 0.3 && u < 0.4 && v > 0.4 && v < 0.6) inverse = 1 / 1.2;
            const double z = 1 / (inverse + noise(random));
            if (!(u > 0.7 && u < 0.8 && v > 0.2)) depth_m(x, y) = static_cast<float>(z);
        }
    return depth_m;
}

TEST(DepthScatter, IsThatOfTheMeasurements) {
    for (const int width : {640, 320, 160})
        for (const double sigma_per_m : {0.001, 0.004, 0.016}) {
            const DepthScatter seen = MeasureDepthScatter(NoisyCorner(width, sigma_per_m), 8);
            EXPECT_NEAR(seen.sigma_per_m / sigma_per_m, 1, 0.15)
                << width << " columns, " << sigma_per_m;
            EXPECT_GT(seen.samples, 1000);
        }
}

TEST(DepthScatter, IsNothingOnPlanesWithoutNoise) {
    EXPECT_LT(MeasureDepthScatter(NoisyCorner(640, 0), 8).sigma_per_m, 1e-5);
}

// As a desk's things are before a wall.
TEST(DepthScatter, IsNotThatOfNearThings) {
    DepthImage depth_m = NoisyCorner(640, 0.002);
    for (int y = 240; y < 480; ++y)
        for (int x = 0; x < 640; ++x)
            depth_m(x, y) = static_cast<float>(0.9 + 0.1 * std::sin(0.3 * x) * std::sin(0.3 * y));
    EXPECT_NEAR(MeasureDepthScatter(depth_m, 8).sigma_per_m, 0.002, 0.15 * 0.002);
}

TEST(DepthScatter, LeavesOutWhatIsTooFar) {
    const DepthImage depth_m = NoisyCorner(640, 0.004);
    const DepthScatter near = MeasureDepthScatter(depth_m, 2.5),
                       all = MeasureDepthScatter(depth_m, 8);
    EXPECT_LT(near.samples, all.samples);
    EXPECT_LE(near.depth_m, 2.5);
    EXPECT_EQ(MeasureDepthScatter(DepthImage(640, 480, 0.0f), 8).samples, 0);
    EXPECT_EQ(MeasureDepthScatter(DepthImage(2, 2, 1.0f), 8).samples, 0);
}

// Frames of a noisy corner, with a bad one before each.
class NoisySource : public FrameSource {
  public:
    NoisySource(double sigma_per_m, bool live) : sigma_per_m_(sigma_per_m) { info_.live = live; }
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        if (std::exchange(bad_next_, !bad_next_)) return {ReadStatus::kSkip, "bad"};
        if (next_ == kFrames) return {ReadStatus::kEnd, {}};
        frame.index = next_;
        frame.depth_m = NoisyCorner(160, sigma_per_m_, static_cast<unsigned>(next_++));
        return {};
    }
    bool Seek(std::int64_t index) override {
        if (info_.live || index >= kFrames) return false;
        next_ = index;
        bad_next_ = true;
        return true;
    }

  private:
    static constexpr std::int64_t kFrames = 70;
    SourceInfo info_;
    double sigma_per_m_;
    std::int64_t next_ = 0;
    bool bad_next_ = true;
};

class NoiseBand : public testing::Test {
  protected:
    NoiseBand() { config.frame.max_depth_m = kFarthest_m; }
    std::string Fit(double sigma_per_m, bool live) {
        source = std::make_unique<NoisySource>(sigma_per_m, live);
        return FitBandToNoise({}, config, source, stop);
    }
    PipelineConfig config;
    std::atomic<bool> stop{false};
    std::unique_ptr<FrameSource> source;
};

TEST_F(NoiseBand, StaysWhereTheCameraIsGood) {
    EXPECT_EQ(Fit(0.0001, false), "");
    EXPECT_EQ(config.map.band_per_m, 0);
    EXPECT_EQ(config.map.range_m(), 0.04);
}

// Near the camera the band stays narrow. The view's median depth is 2.5 m.
TEST_F(NoiseBand, GrowsWithTheNoise) {
    EXPECT_EQ(Fit(0.001, false), "");
    EXPECT_NEAR(config.map.band_per_m, 0.004, 0.15 * 0.004);
    EXPECT_FLOAT_EQ(config.map.band().At(2.0f), 0.04f);
    EXPECT_NEAR(config.map.band().At(5.0f), 0.1, 0.015);
}

TEST_F(NoiseBand, SaysThatACameraIsBad) {
    for (const bool live : {false, true}) {
        config.map.band_per_m = 0;
        EXPECT_NE(Fit(0.005, live), "");
        EXPECT_NEAR(config.map.band_per_m, 0.02, 0.15 * 0.02);
        EXPECT_EQ(config.map.truncation_m, 0.04);
    }
}

TEST_F(NoiseBand, IsNeverMoreThanFourTimesAsWide) {
    Fit(0.1, false);
    EXPECT_FLOAT_EQ(config.map.band().At(8.0f), 0.16f);
}

TEST_F(NoiseBand, IsAsGivenIfAskedFor) {
    config.band_sigmas = 0;
    EXPECT_EQ(Fit(0.1, true), "");
    EXPECT_EQ(config.map.band_per_m, 0);
    config = {};
    config.map.band_per_m = 0.003;
    EXPECT_EQ(Fit(0.1, true), "");
    EXPECT_EQ(config.map.band_per_m, 0.003);
}

// Whether the source can seek or not, the run gets each frame and each message once, in order.
TEST_F(NoiseBand, LosesNoFrame) {
    for (const bool live : {false, true}) {
        Fit(0.005, live);
        Frame frame;
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(source->Read(frame).message, "bad");
            ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
            EXPECT_EQ(frame.index, i);
            EXPECT_EQ(frame.depth_m, NoisyCorner(160, 0.005, static_cast<unsigned>(i)));
        }
    }
}

// A small stereo camera's depth: with the band as given, icp fuses one frame of them.
TEST(NoisyCamera, IsTrackedByIcp) {
    RunConfig config;
    config.synthetic.camera = {212, 120, 154, 154, 105.5, 59.5};
    config.synthetic.frames = 20;
    config.synthetic.sensor.noise = NoiseModel::kKinect;
    config.synthetic.sensor.focal_px = 425;
    config.synthetic.sensor.baseline_m = 0.05;
    config.synthetic.sensor.disparity_std_px = 0.1;
    config.synthetic.sensor.correlation_px = 3;
    config.pipeline.trackers.method = TrackingMethod::kIcpRgb;
    RunRequest request;
    request.source = "synthetic:room";
    const auto run = ExecuteRun(request, config, {}, {});
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_GE(run.value().counts.fused, 18);
}

// A camera that gives nothing, as a source that waits half a second each time.
class SilentSource : public NoisySource {
  public:
    SilentSource() : NoisySource(0, true) {}
    ReadResult Read(Frame&) override {
        ++reads;
        return {ReadStatus::kWait, {}};
    }
    int reads = 0;
};

TEST_F(NoiseBand, DoesNotWaitLongForASilentCamera) {
    for (const bool stopped : {false, true}) {
        auto silent = std::make_unique<SilentSource>();
        const int& reads = silent->reads;
        source = std::move(silent);
        stop = stopped;
        EXPECT_EQ(FitBandToNoise({}, config, source, stop), "");
        EXPECT_EQ(reads, stopped ? 0 : 4);
    }
}

}  // namespace
}  // namespace tessera
