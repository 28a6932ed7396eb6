#include "optimize/frame_average.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/se3.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

Eigen::Isometry3d MovedPose(double x_m, double turned_rad) {
    return SmoothPath(0) *
           Se3Exp((Vector6d() << 0, turned_rad, 0, x_m, 0.3 * x_m, -0.5 * x_m).finished());
}

Frame FrameFrom(const Eigen::Isometry3d& T_world_camera) {
    return BoxRoom().Render(SmallCamera(), T_world_camera, 0);
}

// Adds structured light's noise, with a standard deviation of 2 mm / m^2.
void AddDepthNoise(std::mt19937& random, Frame& frame) {
    std::normal_distribution<float> noise(0, 0.002f);
    for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
        float& z = frame.depth_m.data()[i];
        z += z * z * noise(random);
    }
}

double Rms_m(const DepthImage& a, const DepthImage& b, int border) {
    double sum = 0;
    int count = 0;
    for (int y = border; y < a.height() - border; ++y)
        for (int x = border; x < a.width() - border; ++x) {
            if (a(x, y) <= 0 || b(x, y) <= 0) continue;
            sum += (a(x, y) - b(x, y)) * (a(x, y) - b(x, y));
            ++count;
        }
    return std::sqrt(sum / std::max(1, count));
}

// Seen from elsewhere, the depth of the first view does not change: with moving frames whose depth
// was not carried to the first view, it would be off by 30 mm.
TEST(FrameAverage, IsTheFirstViewOfTheSameSurface) {
    const Eigen::Isometry3d first = MovedPose(0, 0);
    const Frame true_first = FrameFrom(first);
    FrameAverage average;
    average.Begin(true_first, SmallCamera(), Eigen::Isometry3d::Identity(), {});
    for (const double step : {0.3, 0.6, 0.9}) {
        const Eigen::Isometry3d pose = MovedPose(0.025 * step, 0.04 * step);
        ASSERT_TRUE(average.Add(FrameFrom(pose), first.inverse() * pose, {}));
    }
    const DepthImage& mean = average.Take().depth_m;
    EXPECT_LT(Rms_m(mean, true_first.depth_m, 0), 0.001);
    // Not merely the first frame's depth.
    EXPECT_GT(Rms_m(mean, true_first.depth_m, 0), 1e-6);
}

// Bilinear interpolation averages, too, so the mean of five has less than 1 / sqrt(5) of the noise.
TEST(FrameAverage, HasLessNoise) {
    const Eigen::Isometry3d first = MovedPose(0, 0);
    const Frame true_first = FrameFrom(first);
    std::mt19937 random(3);
    Frame noisy = true_first;
    AddDepthNoise(random, noisy);
    FrameAverage average;
    average.Begin(noisy, SmallCamera(), Eigen::Isometry3d::Identity(), {});
    for (int i = 1; i < 5; ++i) {
        const Eigen::Isometry3d pose = MovedPose(0.004 * i, 0.003 * i);
        Frame frame = FrameFrom(pose);
        AddDepthNoise(random, frame);
        ASSERT_TRUE(average.Add(frame, first.inverse() * pose, {}));
    }
    const double before_m = Rms_m(noisy.depth_m, true_first.depth_m, 20);
    EXPECT_LT(Rms_m(average.Take().depth_m, true_first.depth_m, 20), before_m / 2);
}

TEST(FrameAverage, WeighsAsMuchAsItsFrames) {
    Integrator::View view;
    view.weight = 0.5f;
    view.colour_weight = 0.25f;
    FrameAverage average;
    average.Begin(FrameFrom(MovedPose(0, 0)), SmallCamera(), Eigen::Isometry3d::Identity(), view);
    view.weight = 1;
    ASSERT_TRUE(average.Add(FrameFrom(MovedPose(0, 0)), Eigen::Isometry3d::Identity(), view));
    EXPECT_FLOAT_EQ(average.view().weight, 1.5f);
    EXPECT_FLOAT_EQ(average.view().colour_weight, 0.5f);
}

// A refused colour keeps its image: it must not count as that of frames whose colour is good.
TEST(FrameAverage, OneColourIsNotAveragedWithARefusedOne) {
    const Frame frame = FrameFrom(MovedPose(0, 0));
    Integrator::View good, refused;
    refused.colour_weight = 0;
    for (const bool good_first : {false, true}) {
        FrameAverage average;
        average.Begin(frame, SmallCamera(), Eigen::Isometry3d::Identity(),
                      good_first ? good : refused);
        EXPECT_FALSE(
            average.Add(frame, Eigen::Isometry3d::Identity(), good_first ? refused : good));
        EXPECT_TRUE(average.Add(frame, Eigen::Isometry3d::Identity(), good_first ? good : refused));
        EXPECT_EQ(average.view().colour_weight > 0, good_first);
    }
}

TEST(FrameAverage, LeavesOutWhatIsMissingOrAnotherSurface) {
    const Frame first = FrameFrom(MovedPose(0, 0));
    Frame second = first;
    for (float* z = second.depth_m.data(); z != second.depth_m.data() + second.depth_m.size(); ++z)
        *z -= 0.3f;  // somebody passes by
    Frame third = first;
    third.depth_m(40, 40) = 0;
    Frame missing = first;
    missing.depth_m(20, 20) = 0;
    FrameAverage average;
    average.Begin(missing, SmallCamera(), Eigen::Isometry3d::Identity(), {});
    ASSERT_TRUE(average.Add(second, Eigen::Isometry3d::Identity(), {}));
    ASSERT_TRUE(average.Add(third, Eigen::Isometry3d::Identity(), {}));
    const DepthImage& mean = average.Take().depth_m;
    EXPECT_EQ(mean(20, 20), 0);
    EXPECT_FLOAT_EQ(mean(40, 40), first.depth_m(40, 40));
    EXPECT_LT(Rms_m(mean, first.depth_m, 0), 1e-6);
}

TEST(FrameAverage, EndsWhenTheCameraHasMovedOrEnoughAreIn) {
    const Frame frame = FrameFrom(MovedPose(0, 0));
    const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
    FrameAverage average;
    EXPECT_FALSE(average.Add(frame, here, {}));  // no first frame
    average.Begin(frame, SmallCamera(), here, {});
    EXPECT_FALSE(average.Add(frame, Eigen::Isometry3d(Eigen::Translation3d(0.06, 0, 0)), {}));
    EXPECT_FALSE(average.Add(
        frame, Eigen::Isometry3d(Eigen::AngleAxisd(0.09, Eigen::Vector3d::UnitY())), {}));
    Frame grey = frame;
    grey.colour = {};
    EXPECT_FALSE(average.Add(grey, here, {}));
    int added = 0;
    while (average.Add(frame, here, {})) ++added;
    EXPECT_EQ(added, 7);
    average.Take();
    EXPECT_TRUE(average.empty());
    EXPECT_FALSE(average.Add(frame, here, {}));
}

}  // namespace
}  // namespace tessera
