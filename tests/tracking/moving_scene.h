// Objects that move in front of a wall, with exact depth images and a map of the wall.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tracking/moving_detector.h"

namespace tessera::moving_test {

inline constexpr int kWidth = 128, kHeight = 96;
inline constexpr float kWall_m = 3.0f, kBox_m = 1.5f;
inline constexpr double kFrame_s = 1.0 / 30;
inline const PinholeCamera kCamera{kWidth, kHeight, 105, 105, 63.5, 47.5};

// A rectangle of pixels at a depth in front of the wall.
struct Box {
    int left = 0, right = 0, top = 0, bottom = 0;
    float depth_m = kBox_m;
    bool Has(int x, int y) const { return x >= left && x < right && y >= top && y < bottom; }
};

inline DepthImage View(const Box& box) {
    DepthImage depth_m(kWidth, kHeight, kWall_m);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            if (box.Has(x, y)) depth_m(x, y) = box.depth_m;
    return depth_m;
}

// A pillar in front of a cylindrical wall, seen from the centre by a camera that has turned by
// `yaw_rad`.
inline DepthImage RoundView(double yaw_rad) {
    DepthImage depth_m(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double from_axis_rad = std::atan((x - kCamera.cx) / kCamera.fx);
            const float away_m = std::abs(from_axis_rad + yaw_rad) < 0.15 ? kBox_m : kWall_m;
            depth_m(x, y) = away_m * static_cast<float>(std::cos(from_axis_rad));
        }
    return depth_m;
}

inline void HideRows(int rows, DepthImage& depth_m) {
    std::fill_n(depth_m.data(), rows * kWidth, 0.0f);
}

// A map of the wall and, optionally, a box. Of the camera position only the translation along z
// matters.
class WallAndBox : public ViewPredictor {
  public:
    Box box;
    int unknown_rows = 0;  // at the top
    bool round = false;    // predicts RoundView instead
    void Predict(const BlockMap&, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float, float,
                 PredictedView& view) override {
        DepthImage depth_m = View(box);
        HideRows(unknown_rows, depth_m);
        if (round)
            depth_m =
                RoundView(std::atan2(T_world_camera.linear()(0, 2), T_world_camera.linear()(2, 2)));
        view.Resize(camera, T_world_camera);
        const auto ahead_m = static_cast<float>(T_world_camera.translation().z());
        const int every = kWidth / camera.width;
        for (int y = 0; y < camera.height; ++y)
            for (int x = 0; x < camera.width; ++x)
                view.depth_m(x, y) = depth_m(every * x, every * y) - ahead_m;
    }
};

class MovingDetectorTest : public ::testing::Test {
  protected:
    std::shared_ptr<const MovingMask> See(const DepthImage& depth_m) {
        stamp_s_ += kFrame_s;
        return detector_.Find(
            {.depth_m = depth_m, .stamp_s = stamp_s_, .T_world_camera = T_world_camera_}, map_,
            wall_);
    }
    // A box 35 pixels (half a metre) wide, shifted right by `way` pixels.
    static Box BoxAt(double way) {
        const int left = 20 + static_cast<int>(std::lround(way));
        return {left, left + 35, 10, 90};
    }

    MovingDetector detector_{{}, kCamera};
    BlockMap map_{BlockMap::Config()};
    WallAndBox wall_;
    Eigen::Isometry3d T_world_camera_ = Eigen::Isometry3d::Identity();
    double stamp_s_ = 100;
};

}  // namespace tessera::moving_test
