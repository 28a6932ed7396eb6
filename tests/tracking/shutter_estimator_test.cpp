#include "tracking/shutter_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "support/box_room.h"
#include "tracking/residual_sums.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;

// A camera that rotates in a textured room and takes each colour row at its own time. The poses are
// known, so the residuals come only from the shutter.
class Shutter : public testing::Test {
  protected:
    // An image whose colour is `delay_s` late and read out over `readout_s`.
    Frame Render(const Eigen::Isometry3d& T, const Vector6d& twist, double delay_s,
                 double readout_s) const {
        Frame frame = room.Render(camera, T);
        for (int v = 0; v < camera.height; ++v) {
            const double time =
                delay_s + readout_s * (static_cast<double>(v) / camera.height - 0.5);
            const Eigen::Isometry3d T_row = T * Se3Exp(twist * time);
            for (int u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d ray = T_row.linear() * camera.Unproject(u, v, 1.0);
                const double i =
                    room.Intensity(T_row.translation() + room.Cast(T_row.translation(), ray) * ray);
                const auto grey = static_cast<std::uint8_t>(255.0 * i + 0.5);
                frame.colour(u, v) = {grey, grey, grey};
            }
        }
        return frame;
    }

    void Learn(ShutterEstimator& estimator, double delay_s, double readout_s) const {
        for (int i = 0; i < 40; ++i) {
            Vector6d twist;
            twist << 0.9 * std::sin(0.5 * i), 1.2 * std::cos(0.4 * i), 0.5 * std::sin(0.7 * i), 0.1,
                -0.1, 0.05;
            const Eigen::Isometry3d T = testing_support::SmoothPath(5 * i);
            PreparedFrame prepared;
            PrepareFrame(Render(T, twist, delay_s, readout_s), {}, prepared);
            FrameMotion motion;
            motion.twist_per_s = twist;
            motion.colour_delay_s = estimator.delay_s();
            motion.colour_readout_s = estimator.readout_s();
            FramePoints points;
            points.Build(MakePointArguments(prepared, camera, motion, 1, {2.0}, true));
            PointResiduals residuals;
            residuals.Resize(points.count());
            std::ranges::fill(residuals.distance_m, std::numeric_limits<float>::quiet_NaN());
            std::ranges::fill(residuals.intensity, std::numeric_limits<float>::quiet_NaN());
            for (std::size_t k = 0; k < residuals.intensity.size(); ++k)
                if (points.weight[k] > 0 && points.intensity[k] >= 0)
                    residuals.intensity[k] =
                        static_cast<float>(room.Intensity(
                            T * Eigen::Vector3d(points.x[k], points.y[k], points.z[k]))) -
                        points.intensity[k];
            if (!estimator.Wants(motion, 0.05)) continue;
            ResidualArguments a = MakeResidualArguments(prepared, camera, points, residuals);
            for (int k = 0; k < 6; ++k) a.twist_per_s[k] = motion.twist_per_s(k);
            a.colour_delay_s = motion.colour_delay_s;
            a.colour_readout_s = motion.colour_readout_s;
            a.gain = 1.0;
            a.residual_scale = 0.05;
            a.wants_shutter = true;
            estimator.Update(SumResiduals(a).shutter, 0.05);
        }
    }

    BoxRoom room;
    PinholeCamera camera = SmallCamera();
};

TEST_F(Shutter, LearnsARollingOne) {
    ShutterEstimator estimator({});
    Learn(estimator, 0.003, 0.02);
    EXPECT_NEAR(estimator.delay_s(), 0.003, 0.0005);
    EXPECT_NEAR(estimator.readout_s(), 0.02, 0.002);
}

TEST_F(Shutter, LearnsAGlobalOneAsZero) {
    ShutterEstimator estimator({});
    Learn(estimator, 0.0, 0.0);
    EXPECT_NEAR(estimator.delay_s(), 0.0, 0.0003);
    EXPECT_NEAR(estimator.readout_s(), 0.0, 0.001);
}

TEST_F(Shutter, BeginsWhereItIsToldAndLearnsTheRest) {
    ShutterEstimator estimator({.readout_s = 0.028});
    EXPECT_EQ(estimator.readout_s(), 0.028);
    Learn(estimator, 0.003, 0.02);
    EXPECT_NEAR(estimator.readout_s(), 0.02, 0.002);
    estimator.Reset();
    EXPECT_EQ(estimator.readout_s(), 0.028);
}

TEST_F(Shutter, StaysAtZeroWhenSwitchedOff) {
    ShutterEstimator::Config config;
    config.enabled = false;
    config.readout_s = 0.02;
    ShutterEstimator estimator(config);
    Learn(estimator, 0.003, 0.02);
    EXPECT_EQ(estimator.delay_s(), 0.0);
    EXPECT_EQ(estimator.readout_s(), 0.0);
}

// A scan is resumed with the estimator switched off.
TEST_F(Shutter, ForgetsWhatAStateHasLearntWhereItIsSwitchedOff) {
    for (const bool enabled : {true, false}) {
        std::vector<std::uint8_t> saved;
        StateWriter written(saved);
        ShutterEstimator({.readout_s = 0.02}).SaveState(written);
        ShutterEstimator estimator({.enabled = enabled});
        StateReader state(saved);
        EXPECT_TRUE(estimator.LoadState(state));
        EXPECT_TRUE(state.at_end());
        EXPECT_EQ(estimator.readout_s(), enabled ? 0.02 : 0.0);
    }
}

}  // namespace
}  // namespace tessera
