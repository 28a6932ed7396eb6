#include "optimize/keyframes.h"

#include <gtest/gtest.h>

#include "core/se3.h"

namespace tessera {
namespace {

// atan(1/2), half the field of view of a camera with fx = width.
constexpr double kHalfAngle_rad = 0.4636476;

PinholeCamera Wide() { return {160, 160, 160, 160, 79.5, 79.5}; }

Eigen::Isometry3d Shift(double x, double y = 0, double z = 0) {
    return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

PreparedFrame Wall(float depth_m) {
    PreparedFrame frame;
    frame.depth_m = DepthImage(160, 160, depth_m);
    return frame;
}

TrackResult TrackedAt(const Eigen::Isometry3d& T) {
    TrackResult track;
    track.T_world_camera = T;
    return track;
}

// At 2 m the image is 2 m wide, so a sideways step of 0.5 m leaves three quarters of it.
TEST(ViewOverlap, OfAWallIsWhatTheStepLeaves) {
    const DepthImage depth(16, 16, 2.0f);
    const PinholeCamera view = Wide().Every(10);
    EXPECT_DOUBLE_EQ(ViewOverlap(depth, view, Shift(0)), 1.0);
    EXPECT_DOUBLE_EQ(ViewOverlap(depth, view, Shift(0.5)), 0.75);
    EXPECT_DOUBLE_EQ(ViewOverlap(depth, view, Shift(0, -1)), 0.5);
    EXPECT_DOUBLE_EQ(ViewOverlap(depth, view, Shift(0, 0, -3)), 0.0);   // behind the other camera
    EXPECT_DOUBLE_EQ(ViewOverlap(depth, view, Shift(0, 0, 0.3)), 1.0);  // 2.3 m instead of 2
    // Still in view, but the scale differs by more than a fifth.
    EXPECT_DOUBLE_EQ(ViewOverlap(depth, view, Shift(0, 0, 0.5)), 0.0);
    EXPECT_DOUBLE_EQ(ViewOverlap(DepthImage(16, 16, 0.0f), view, Shift(0)), 0.0);
}

TEST(ReducedDepth, TakesTheMiddlePixelOfEachCell) {
    DepthImage depth(9, 6, 0.0f);
    depth(1, 1) = 1;
    depth(7, 4) = 2;
    const DepthImage reduced = ReducedDepth(depth, 3);
    ASSERT_EQ(reduced.width(), 3);
    ASSERT_EQ(reduced.height(), 2);
    EXPECT_EQ(reduced(0, 0), 1);
    EXPECT_EQ(reduced(2, 1), 2);
}

TEST(Keyframes, OneIsWantedWhereTheLastHasLeftThePicture) {
    Keyframes keyframes(Wide(), 0.7, 10);
    EXPECT_TRUE(keyframes.Wanted(Wall(2), Shift(0)));
    keyframes.Add(0, 0, Wall(2), TrackedAt(Shift(0)));
    EXPECT_FALSE(keyframes.Wanted(Wall(2), Shift(0.5)));
    EXPECT_TRUE(keyframes.Wanted(Wall(2), Shift(0.8)));
    EXPECT_TRUE(keyframes.Wanted(
        Wall(2), Eigen::Isometry3d(Eigen::AngleAxisd(kHalfAngle_rad, Eigen::Vector3d::UnitY()))));
}

TEST(Keyframes, CountTheWay) {
    Keyframes keyframes(Wide(), 0.7, 10);
    keyframes.Follow(Shift(0));
    keyframes.Add(0, 0, Wall(2), TrackedAt(Shift(0)));
    keyframes.Follow(Shift(1));
    keyframes.Follow(Shift(0));
    keyframes.Jump();
    keyframes.Follow(Shift(5));
    const Eigen::Isometry3d turned = Shift(5) * Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitZ());
    keyframes.Follow(turned);
    const Keyframe& second = keyframes.Add(7, 1.5, Wall(2), TrackedAt(turned));
    EXPECT_EQ(second.id, 1);
    EXPECT_EQ(second.frame_index, 7);
    EXPECT_DOUBLE_EQ(second.path_length_m, 2);  // the jump is not counted
    EXPECT_NEAR(second.turned_rad, 0.25, 1e-12);
    EXPECT_TRUE(second.T_map_camera.isApprox(turned));
}

}  // namespace
}  // namespace tessera
