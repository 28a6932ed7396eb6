#include "tracking/sdf_tracker.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tracking_world.h"

namespace tessera {
namespace {

using namespace testing_support;

TEST(SdfTracker, ExposureChangeIsExplainedByBrightness) {
    BoxRoom room;
    room.has_ball = true;
    const World world(room);
    const Eigen::Isometry3d T_true = SmoothPath(20);
    Frame frame = world.room.Render(world.camera, T_true);
    for (std::size_t i = 0; i < frame.colour.size(); ++i) {
        Rgb8& c = frame.colour.data()[i];
        c.r = c.g = c.b = static_cast<std::uint8_t>(0.8 * c.r + 10.0 + 0.5);
    }
    const PreparedFrame prepared = Prepare(frame);
    ResidualModel::Config config = FixedAlpha(0.3);
    config.brightness_prior = 1e-3;
    const TestTracker tracker = FineSdf(config);
    const TrackResult result = world.Track(*tracker, prepared, SmoothPath(19), SmoothPath(19));
    // map = gain * image + offset, so gain = 1 / 0.8 and offset = -10 / 255 / 0.8, except for the
    // effect of the prior.
    EXPECT_NEAR(result.gain, 1.25, 0.07);
    EXPECT_LT((T_true.inverse() * result.T_world_camera).translation().norm(), 0.002);
}

// Paints the texture in chroma: grey level g becomes a colour of luma 0.5, red where g is high and
// cyan where it is low.
void PaintAtEqualLuma(Frame& frame) {
    for (std::size_t i = 0; i < frame.colour.size(); ++i) {
        Rgb8& c = frame.colour.data()[i];
        const double r = c.r, green = (127.5 - 0.299 * r - 0.114 * 127.5) / 0.587;
        c = {c.r, static_cast<std::uint8_t>(green + 0.5), 128};
    }
}

// [B14] eq. 6 sees texture of equal luma; luma alone sees only its rounding.
TEST(SdfTracker, ChromaShowsMotionAlongAWallOfEqualLuma) {
    BoxRoom room;
    room.only_back_wall = true;
    World world(room);
    world.map.Clear();
    Integrator integrator({}, world.camera);
    for (int i = 0; i < 12; ++i) {
        Integrator::View view;
        view.T_world_camera = SmoothPath(6 * i);
        Frame frame = world.room.Render(world.camera, view.T_world_camera);
        PaintAtEqualLuma(frame);
        integrator.Integrate(Prepare(frame), view, world.map);
    }
    const Eigen::Isometry3d T_true = SmoothPath(20);
    Frame frame = world.room.Render(world.camera, T_true);
    PaintAtEqualLuma(frame);
    const PreparedFrame prepared = Prepare(frame);
    const Eigen::Isometry3d T_start = T_true * Eigen::Translation3d(0.012, 0.008, 0);
    const auto error = [&](bool chroma) {
        const TestTracker tracker = FineSdf(FixedAlpha(0.3), chroma);
        const TrackResult result = world.Track(*tracker, prepared, T_start, T_start);
        return (T_true.inverse() * result.T_world_camera).translation().norm();
    };
    EXPECT_LT(error(true), 0.003);
    EXPECT_GT(error(false), 0.005);
}

// The colour image of a moving camera is taken 15 ms after the depth image.
TEST(SdfTracker, ColourDelayIsAllowedFor) {
    BoxRoom room;
    room.only_back_wall = true;  // only colour determines the sideways motion
    const World world(room);
    Vector6d step;  // per frame
    step << 0, 0.02, 0, 0.02, 0, 0;
    const Eigen::Isometry3d T_last = SmoothPath(10), T_true = T_last * Se3Exp(step);
    const double delay_share = 0.45;
    Frame frame = world.room.Render(world.camera, T_true);
    frame.colour = world.room.Render(world.camera, T_true * Se3Exp(step * delay_share)).colour;
    const PreparedFrame prepared = Prepare(frame);
    const auto error = [&](bool allow) {
        const TestTracker tracker = FineSdf(FixedAlpha(0.3));
        const TrackResult result = world.Track(*tracker, prepared, T_true, T_last,
                                               {.colour_delay_s = allow ? delay_share / 30 : 0});
        return (T_true.inverse() * result.T_world_camera).translation().norm();
    };
    EXPECT_LT(error(true), 0.003);
    EXPECT_GT(error(false), 2 * error(true));
}

TEST(SdfTracker, AutoAlphaGrowsWhenNeighboursShareDistanceErrors) {
    BoxRoom room;
    room.has_ball = true;
    const World world(room);
    const auto settle = [&](double bump_m) {
        ResidualModel::Config config;
        config.auto_alpha_max = 100;
        const TestTracker tracker = FineSdf(config);
        Frame frame = world.room.Render(world.camera, SmoothPath(20));
        for (int v = 0; v < frame.depth_m.height(); ++v)
            for (int u = 0; u < frame.depth_m.width(); ++u)
                frame.depth_m(u, v) +=
                    static_cast<float>(bump_m * std::sin(0.05 * u) * std::cos(0.06 * v));
        const PreparedFrame prepared = Prepare(frame);
        TrackResult result;
        for (int i = 0; i < 3; ++i)
            result = world.Track(*tracker, prepared, SmoothPath(20), SmoothPath(20));
        return result.alpha;
    };
    EXPECT_GT(settle(0.02), 2 * settle(0.0));
}

}  // namespace
}  // namespace tessera
