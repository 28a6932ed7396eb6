// What the detector must not take for a movement.
#include <gtest/gtest.h>

#include <memory>

#include "tracking/moving_detector.h"
#include "tracking/moving_scene.h"

namespace tessera {
namespace moving_test {
namespace {

TEST_F(MovingDetectorTest, NothingMovesInAStaticView) {
    for (int i = 0; i < 60; ++i) EXPECT_EQ(See(View(BoxAt(0))), nullptr) << i;
}

TEST_F(MovingDetectorTest, WhatHasStoodStillForTheWindowBelongsToTheScene) {
    for (int i = 0; i < 10; ++i) See(View({}));
    for (int i = 0; i < 15; ++i) See(View(BoxAt(2.3 * i)));
    const Box stands = BoxAt(2.3 * 14);
    std::shared_ptr<const MovingMask> mask;
    for (int i = 0; i < 15; ++i) mask = See(View(stands));
    EXPECT_NE(mask, nullptr);  // not yet after half a second
    for (int i = 0; i < 18; ++i) mask = See(View(stands));
    EXPECT_TRUE(mask == nullptr || mask->moving_tiles == 0);
}

TEST_F(MovingDetectorTest, APoseThatIsOffIsNoMovement) {
    for (int i = 0; i < 30; ++i) See(View(BoxAt(0)));
    T_world_camera_.translation() = Eigen::Vector3d(0.3, 0, 0.4);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(See(View(BoxAt(0))), nullptr) << i;
}

// A rolling shutter shows the edges where they were up to 15 ms earlier or later.
TEST_F(MovingDetectorTest, EdgesThatATurnHasShiftedDoNotMove) {
    wall_.round = true;
    for (int i = 0; i < 30; ++i) EXPECT_EQ(See(RoundView(0)), nullptr) << i;
    constexpr double kTurn_rad = 0.1, kShutter_rad = kTurn_rad / kFrame_s * 0.015;
    T_world_camera_ = Eigen::Isometry3d(Eigen::AngleAxisd(kTurn_rad, Eigen::Vector3d::UnitY()));
    EXPECT_EQ(See(RoundView(kTurn_rad + kShutter_rad)), nullptr);
}

TEST_F(MovingDetectorTest, SpecksDoNotCount) {
    for (int i = 0; i < 30; ++i) {
        DepthImage depth_m = View({});
        for (int k = 0; k < 40; ++k)
            depth_m((37 * k + 11 * i) % kWidth, (53 * k + 7 * i) % kHeight) = 1.0f;
        EXPECT_EQ(See(depth_m), nullptr) << i;
    }
}

}  // namespace
}  // namespace moving_test
}  // namespace tessera
