#include "synth/frame_renderer.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>

#include "synth/analytic_scene.h"
#include "synth/furniture.h"
#include "synth/paint.h"

namespace tessera {
namespace {

using Eigen::Vector3d;

CameraPath Still(const Eigen::Isometry3d& T_world_camera) {
    return {[=](double) { return T_world_camera; }, 1.0};
}

const PinholeCamera kCamera{96, 72, 90, 91, 47.5, 35.5};

// A wall in the plane y = 2 with a red ball in front of it.
class WallAndBall : public testing::Test {
  protected:
    WallAndBall() {
        Furnisher add(scene_);
        add.Box(StandAt(0, 2.05, -2), {0, 0, 0}, {8, 0.1, 6}, add.Flat({100, 120, 140}));
        scene_.BeginInstance("ball 1", "ball");
        add.Sphere(StandAt(0, 0, 0), p_ball_ - Vector3d(0, 0, kRadius), kRadius,
                   add.Flat({220, 30, 30}));
        Lighting even;
        even.baked = false;
        scene_.Finish(even);
    }
    static constexpr double kRadius = 0.1;
    const Vector3d p_ball_{0.31, 1.2, 0.87};
    AnalyticScene scene_;
};

TEST_F(WallAndBall, DepthIsAlongTheOpticalAxis) {
    // Seen head-on from 2 m, the wall has the same depth everywhere, although the ray lengths
    // differ.
    RenderedView view;
    FrameRenderer(scene_, kCamera).Render(Still(LookAt({0, 0, 1}, {0, 2, 1})), 0, 0, view);
    EXPECT_FLOAT_EQ(view.depth_m(0, 0), 2.0f);
    EXPECT_FLOAT_EQ(view.depth_m(95, 71), 2.0f);
    EXPECT_NEAR(view.cos_incidence(0, 0),
                1 / std::sqrt(1 + std::pow(47.5 / 90, 2) + std::pow(35.5 / 91, 2)), 1e-6);
}

// Oscillates about the vertical axis.
Eigen::Isometry3d Shaken(double time_s) {
    return LookAt({0, 0, 1}, {0, 2, 1}) *
           Eigen::AngleAxisd(0.3 * std::sin(5 * time_s), Vector3d::UnitY());
}

TEST_F(WallAndBall, ARollingShutterReadsEachRowAtItsTime) {
    const CameraPath path{Shaken, 1.0};
    const CameraRig rig{.depth_readout_s = 0.02, .colour_readout_s = 0.03, .colour_delay_s = 0.01};
    RenderedView rolling, depth, colour;
    FrameRenderer(scene_, kCamera, rig).Render(path, 0.4, 0.008, rolling);
    for (const int row : {0, 24, 68}) {  // the first row of a band of four rows
        const double middle = (row + 1.5) / kCamera.height - 0.5;
        const FrameRenderer global(scene_, kCamera);
        global.Render(path, 0.4 + 0.02 * middle, 0.008, depth);
        global.Render(path, 0.4 + 0.01 + 0.03 * middle, 0.008, colour);
        for (int x = 0; x < kCamera.width; ++x) {
            EXPECT_FLOAT_EQ(rolling.depth_m(x, row + 2), depth.depth_m(x, row + 2))
                << x << " " << row;
            EXPECT_FLOAT_EQ(rolling.colour(x, row + 2).r, colour.colour(x, row + 2).r)
                << x << " " << row;
        }
    }
}

TEST_F(WallAndBall, AColourCameraBesideTheDepthCameraSeesFromThere) {
    const Eigen::Isometry3d T = Shaken(0.1);
    RenderedView both, moved;
    FrameRenderer(scene_, kCamera, {.colour_x_m = 0.05, .colour_turn_deg = 2})
        .Render(Still(T), 0, 0, both);
    const double turn_rad = 2 * 3.14159265358979 / 180;
    FrameRenderer(scene_, kCamera)
        .Render(Still(T * Eigen::Translation3d(0.05, 0, 0) *
                      Eigen::AngleAxisd(turn_rad, Vector3d::UnitY())),
                0, 0, moved);
    RenderedView as_was;
    FrameRenderer(scene_, kCamera).Render(Still(T), 0, 0, as_was);
    for (int x = 0; x < kCamera.width; ++x) {
        EXPECT_NEAR(both.colour(x, 40).r, moved.colour(x, 40).r, 1e-3);
        EXPECT_EQ(both.depth_m(x, 40), as_was.depth_m(x, 40));
    }
}

TEST_F(WallAndBall, DepthOfATiltedPlaneFollowsItsEquation) {
    const Eigen::Isometry3d T = LookAt({-3, 0.1, 1}, {-2.4, 2, 1.2});
    RenderedView view;
    FrameRenderer(scene_, kCamera).Render(Still(T), 0, 0, view);
    for (const auto& [x, y] : {std::pair{3, 5}, {40, 60}, {90, 10}}) {
        const Vector3d d_world = T.linear() * kCamera.Unproject(x, y, 1);
        EXPECT_NEAR(view.depth_m(x, y), (2 - T.translation().y()) / d_world.y(), 1e-5)
            << x << " " << y;
    }
}

TEST_F(WallAndBall, APointIsSeenWhereItProjects) {
    const Eigen::Isometry3d T_world_camera = LookAt({-0.4, -0.3, 1.3}, {0.2, 1.0, 0.9});
    RenderedView view;
    FrameRenderer(scene_, kCamera).Render(Still(T_world_camera), 0, 0, view);
    const Eigen::Vector2d expected = kCamera.Project(T_world_camera.inverse() * p_ball_);
    Eigen::Vector2d sum(0, 0);
    int count = 0;
    for (int y = 0; y < 72; ++y) {
        for (int x = 0; x < 96; ++x) {
            if (view.instance(x, y) != 1) continue;
            sum += Eigen::Vector2d(x, y);
            ++count;
            EXPECT_EQ(view.class_id(x, y), 1);
            // Unprojected with its depth, each pixel lies on the ball.
            const Vector3d p = T_world_camera * kCamera.Unproject(x, y, view.depth_m(x, y));
            EXPECT_NEAR((p - p_ball_).norm(), kRadius, 1e-5);
        }
    }
    ASSERT_GT(count, 50);
    EXPECT_NEAR((sum / count - expected).norm(), 0, 0.35);
}

TEST_F(WallAndBall, EdgesAreAntialiased) {
    RenderedView view;
    FrameRenderer(scene_, kCamera).Render(Still(LookAt({0.3, 0, 0.9}, {0.3, 2, 0.9})), 0, 0, view);
    int between = 0;
    for (std::size_t i = 0; i < view.colour.size(); ++i) {
        const float blue = view.colour.data()[i].b;
        if (blue > 40 && blue < 100) ++between;
    }
    EXPECT_GT(between, 8);
}

TEST_F(WallAndBall, MotionDuringTheExposureBlursColourOnly) {
    CameraPath path;
    path.T_world_camera = [](double t) { return LookAt({0.3 + t, 0, 0.9}, {0.3 + t, 2, 0.9}); };
    RenderedView sharp, blurred;
    const FrameRenderer renderer(scene_, kCamera);
    renderer.Render(path, 0.1, 0, sharp);
    renderer.Render(path, 0.1, 0.08, blurred);
    EXPECT_EQ(sharp.depth_m, blurred.depth_m);
    const auto partly_red = [](const RenderedView& view) {
        int count = 0;
        for (int x = 0; x < 96; ++x)
            count += view.colour(x, 37).b > 40 && view.colour(x, 37).b < 100;
        return count;
    };
    EXPECT_LE(partly_red(sharp), 4);
    EXPECT_GE(partly_red(blurred), 6);
}

TEST_F(WallAndBall, OneAndFourThreadsGiveTheSameBytes) {
    const auto render = [&](std::size_t threads) {
        tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        RenderedView view;
        FrameRenderer(scene_, kCamera)
            .Render(Still(LookAt({0.3, 0, 0.9}, {0.2, 2, 0.8})), 0, 0, view, true);
        return view;
    };
    const RenderedView one = render(1), four = render(4);
    EXPECT_EQ(one.depth_m, four.depth_m);
    EXPECT_EQ(one.patch, four.patch);
    for (std::size_t i = 0; i < one.colour.size(); ++i)
        ASSERT_EQ(one.colour.data()[i].r, four.colour.data()[i].r);
}

}  // namespace
}  // namespace tessera
