// RemoveShading against a slow and obvious second implementation, and what it is for.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tracking/residual_sums.h"
#include "tracking/sdf_tracker.h"
#include "tracking_world.h"

namespace tessera {
namespace {

using namespace testing_support;

ShadingArguments ArgumentsOf(int width, const std::vector<float>& residual,
                             std::vector<float>& intensity, float gain) {
    ShadingArguments a{};
    a.width = width;
    a.height = static_cast<int>(residual.size()) / width;
    a.residual = residual.data();
    a.intensity = intensity.data();
    a.gain = gain;
    a.limit = 0.1f;
    return a;
}

// The mean of the residuals in the 3 x 3 patches around a point's, for each point. The patch's own
// row and column count twice.
std::vector<double> SlowShading(const ShadingArguments& a) {
    const int side = a.Patch();
    std::vector<double> shading;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            double sum = 0, count = 0;
            for (int v = 0; v < a.height; ++v)
                for (int u = 0; u < a.width; ++u) {
                    const double r = a.residual[v * a.width + u];
                    if (std::abs(u / side - x / side) > 1 || std::abs(v / side - y / side) > 1 ||
                        std::isnan(r))
                        continue;
                    const double w =
                        (u / side == x / side ? 2 : 1) * (v / side == y / side ? 2 : 1);
                    sum += w * std::clamp(r, -static_cast<double>(a.limit), double{a.limit});
                    count += w;
                }
            shading.push_back(count > 0 ? sum / count : 0);
        }
    return shading;
}

TEST(RemoveShading, AddsTheMeanResidualAroundEachPoint) {
    constexpr int kWidth = 88, kHeight = 37;  // patches of 2 points; the last ones are cut off
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> residual(kWidth * kHeight), intensity(residual.size());
    for (std::size_t i = 0; i < residual.size(); ++i) {
        residual[i] = uniform(random) < 0.3f ? std::numeric_limits<float>::quiet_NaN()
                                             : 0.5f * uniform(random) - 0.2f;
        intensity[i] = uniform(random) < 0.2f ? -1 : 0.3f + 0.5f * uniform(random);
    }
    const ShadingArguments a = ArgumentsOf(kWidth, residual, intensity, 1.25f);
    ASSERT_EQ(a.Patch(), 2);
    const std::vector<double> shading = SlowShading(a);
    const std::vector<float> before = intensity;
    RemoveShading(a);
    for (std::size_t i = 0; i < intensity.size(); ++i)
        ASSERT_NEAR(intensity[i], before[i] < 0 ? -1 : before[i] + shading[i] / 1.25, 1e-5) << i;
}

// Removed again and again, it removes no more than there is.
TEST(RemoveShading, Settles) {
    constexpr int kWidth = 96, kHeight = 60;
    std::mt19937 random(6);
    std::uniform_real_distribution<float> uniform(-0.05f, 0.05f);
    std::vector<float> map(kWidth * kHeight), intensity(map.size(), 0.5f), residual(map.size());
    for (std::size_t i = 0; i < map.size(); ++i)
        map[i] = 0.5f + uniform(random) + 0.04f * std::sin(0.7f * static_cast<float>(i % kWidth));
    const ShadingArguments a = ArgumentsOf(kWidth, residual, intensity, 1);
    const auto rms = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < map.size(); ++i) {
            residual[i] = map[i] - intensity[i];
            sum += static_cast<double>(residual[i]) * residual[i];
        }
        return std::sqrt(sum / static_cast<double>(map.size()));
    };
    double last = rms();
    for (int i = 0; i < 50; ++i) {
        RemoveShading(a);
        const double now = rms();
        ASSERT_LT(now, last + 1e-6) << i;
        last = now;
    }
}

TEST(RemoveShading, IsAThirteenthOfTheImagesWidth) {
    ShadingArguments a{};
    for (const int width : {80, 160, 320, 640, 1280}) {
        a.width = width;
        EXPECT_NEAR(3.0 * a.Patch() / width, 1 / 13.0, 0.01) << width;
    }
}

// A wall along which only colours show the motion, in light that has changed over the image since
// the map was coloured.
class InOtherLight : public ::testing::Test {
  protected:
    static BoxRoom Wall() {
        BoxRoom room;
        room.only_back_wall = true;
        return room;
    }
    InOtherLight() {
        Frame frame = world.room.Render(world.camera, T_true);
        const int width = frame.colour.width();
        for (int v = 0; v < frame.colour.height(); ++v)
            for (int u = 0; u < width; ++u) {
                Rgb8& c = frame.colour(u, v);
                const double light = 0.85 + 0.15 * std::sin(7.0 * u / width) * std::cos(0.02 * v);
                c.r = c.g = c.b = static_cast<std::uint8_t>(light * c.r + 0.5);
            }
        prepared = Prepare(frame);
    }
    TrackResult Track(const TestTracker& tracker) const {
        const Eigen::Isometry3d T_start = T_true * Eigen::Translation3d(0.006, 0.004, 0);
        return world.Track(*tracker, prepared, T_start, T_start);
    }

    const World world{Wall()};
    const Eigen::Isometry3d T_true = SmoothPath(20);
    PreparedFrame prepared;
};

TEST_F(InOtherLight, TheTextureIsLeftToTracking) {
    const auto error = [&](bool remove) {
        ResidualModel::Config config = FixedAlpha(0.3);
        config.remove_shading = remove;
        const TrackResult result = Track(FineSdf(config));
        return (T_true.inverse() * result.T_world_camera).translation().norm();
    };
    EXPECT_LT(error(true), 0.002);
    EXPECT_GT(error(false), 2 * error(true));
}

// Otherwise the next frame's shading would be much larger than usual.
TEST_F(InOtherLight, TheUsualErrorContainsTheShading) {
    for (const char* method : {"sdf", "icp-rgb"}) {
        const TestTracker tracker = std::string(method) == "sdf" ? FineSdf(FixedAlpha(0.3))
                                                                 : FineIcp(FixedAlpha(0.3), true);
        const TrackResult result = Track(tracker);
        PoseSums next;
        next.value[SumLayout::kIntensityWeight] = 1;
        next.value[SumLayout::kIntensityError] = 9 * result.intensity_rms * result.intensity_rms;
        EXPECT_TRUE(tracker.model->TakesForShading(next)) << method;
    }
}

}  // namespace
}  // namespace tessera
