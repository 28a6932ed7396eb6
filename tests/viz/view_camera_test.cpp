#include "viz/view_camera.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

using Eigen::Vector3d;

Vector3d PixelOf(const ViewCamera& camera, const Vector3d& point) {
    const PinholeCamera pinhole = ViewCamera::Camera(640, 480);
    const Vector3d p = camera.T_world_camera().inverse() * point;
    const Eigen::Vector2d pixel = pinhole.Project(p);
    return {pixel.x(), pixel.y(), p.z()};
}

TEST(ViewCamera, LooksUprightAtItsTarget) {
    ViewCamera camera({0, 0, 1});
    camera.Place({3, -1, 2}, {0, 1, 0.5});
    EXPECT_TRUE(camera.eye().isApprox(Vector3d(3, -1, 2), 1e-12));
    const Vector3d target = PixelOf(camera, {0, 1, 0.5});
    EXPECT_NEAR(target.x(), 319.5, 1e-9);
    EXPECT_NEAR(target.y(), 239.5, 1e-9);
    EXPECT_GT(target.z(), 0);
    const Vector3d above = PixelOf(camera, {0, 1, 0.7});
    EXPECT_NEAR(above.x(), 319.5, 1e-9);
    EXPECT_LT(above.y(), 239.5);
    EXPECT_NEAR(camera.T_world_camera().linear().determinant(), 1, 1e-12);
}

TEST(ViewCamera, PanningMovesTheTargetsPlaneWithThePointer) {
    ViewCamera camera({0, -1, 0});
    camera.Place({0, -1, -3}, {0, 0, 0});
    camera.Pan(30, -20, 480);
    const Vector3d moved = PixelOf(camera, {0, 0, 0});
    EXPECT_NEAR(moved.x(), 319.5 + 30, 1e-6);
    EXPECT_NEAR(moved.y(), 239.5 - 20, 1e-6);
}

TEST(ViewCamera, TurningKeepsTheTargetAndFollowsThePointer) {
    ViewCamera camera({0, -1, 0});
    camera.Place({0, -1, -3}, {0, 0, 0});
    const double distance = camera.distance_m();
    const Vector3d near_side = camera.eye() * 0.5;
    const Vector3d before = PixelOf(camera, near_side);
    camera.Rotate(0.1, 0);
    EXPECT_GT(PixelOf(camera, near_side).x(), before.x());
    camera.Rotate(0, 0.1);
    EXPECT_GT(PixelOf(camera, near_side).y(), before.y());
    EXPECT_NEAR(camera.distance_m(), distance, 1e-12);
    camera.Rotate(0, 10);  // stops at the pole and stays upright
    EXPECT_NEAR(camera.eye().dot(camera.up()), distance, 1e-3);
    EXPECT_TRUE(camera.T_world_camera().matrix().allFinite());
}

TEST(ViewCamera, ZoomIsBounded) {
    ViewCamera camera;
    camera.Zoom(1e-9);
    EXPECT_EQ(camera.distance_m(), 0.05);
    camera.Zoom(1e9);
    EXPECT_EQ(camera.distance_m(), 500);
}

TEST(ViewCamera, FirstPersonTurnsAroundTheEyeAndWalks) {
    ViewCamera camera({0, -1, 0});
    camera.Place({0, 0, 0}, {0, 0, 2});
    const Vector3d ahead(0, 0, 5);
    camera.Turn(0.1, 0);  // to the right: what was ahead moves to the left
    EXPECT_LT(camera.eye().norm(), 1e-9);
    EXPECT_LT(PixelOf(camera, ahead).x(), 319);
    EXPECT_NEAR(PixelOf(camera, ahead).y(), 239.5, 1e-6);
    camera.Turn(-0.1, 0.1);  // down: it moves up
    EXPECT_LT(PixelOf(camera, ahead).y(), 239);
    camera.Place({0, 0, 0}, {0, 0, 2});
    camera.Walk(0.5);
    EXPECT_TRUE(camera.eye().isApprox(Vector3d(0, 0, 0.5), 1e-9));
    EXPECT_NEAR(camera.distance_m(), 2, 1e-9);
}

TEST(ViewCamera, FollowsInsideTheSensor) {
    ViewCamera camera({0, -1, 0});
    Eigen::Isometry3d sensor = Eigen::Isometry3d::Identity();
    sensor.translation() = Vector3d(2, 0, 5);
    camera.FollowInside(sensor, -1);
    EXPECT_TRUE(camera.eye().isApprox(sensor.translation(), 1e-9));
    EXPECT_NEAR(PixelOf(camera, Vector3d(2, 0, 9)).x(), 319.5, 1e-6);
}

TEST(ViewCamera, AScaleBarIsARoundLength) {
    EXPECT_DOUBLE_EQ(ScaleBarLength_m(0.73), 0.5);
    EXPECT_DOUBLE_EQ(ScaleBarLength_m(0.27), 0.2);
    EXPECT_DOUBLE_EQ(ScaleBarLength_m(19), 10);
    EXPECT_EQ(ScaleBarLength_m(0), 0);
    ViewCamera camera;
    camera.Place({0, 0, 0}, {0, 0, 2});
    const double pixel_m = PixelOf(camera, {0.1, 0, 2}).x() - PixelOf(camera, {0, 0, 2}).x();
    EXPECT_NEAR(std::abs(pixel_m) * camera.PixelSize_m(480), 0.1, 1e-9);
}

TEST(ViewCamera, ANewUpKeepsThePlace) {
    ViewCamera camera({0, -1, 0});
    camera.Place({1, -1, -3}, {0.2, 0, 0.1});
    const Vector3d eye = camera.eye();
    camera.SetUp({0.1, -1, -0.3});
    EXPECT_TRUE(camera.eye().isApprox(eye, 1e-9));
    EXPECT_TRUE(camera.target().isApprox(Vector3d(0.2, 0, 0.1)));
}

TEST(ViewCamera, FollowsFromBehindAndAbove) {
    ViewCamera camera({0, -1, 0});
    Eigen::Isometry3d sensor = Eigen::Isometry3d::Identity();
    sensor.translation() = Vector3d(2, 0, 5);
    camera.Follow(sensor, -1);
    EXPECT_LT(camera.eye().z(), 5);
    EXPECT_LT(camera.eye().y(), 0);
    const Vector3d seen = PixelOf(camera, sensor.translation());
    EXPECT_GT(seen.z(), 0);
    EXPECT_NEAR(seen.x(), 319.5, 1e-6);
    // Half a second after a jump the view has covered most of the distance. It never overshoots.
    sensor.translation().x() = 3;
    const double before = camera.eye().x();
    for (int i = 0; i < 15; ++i) camera.Follow(sensor, 1.0 / 30);
    EXPECT_GT(camera.eye().x(), before + 0.75);
    EXPECT_LT(camera.eye().x(), before + 1);
}

}  // namespace
}  // namespace tessera
