#include "tracking/point_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/se3.h"
#include "tracking/frame_points.h"

namespace tessera {
namespace {

TEST(PointKernels, WeightIsTheInverseVarianceFromHalfAMetreOn) {
    // 1 / (z^2 + z^4 / noise_depth^2)
    EXPECT_FLOAT_EQ(PointWeight(2.0f, 2.0f, 0.5f), 1 / 8.0f);
    EXPECT_FLOAT_EQ(PointWeight(4.0f, 2.0f, 0.5f), 1 / 80.0f);
    EXPECT_FLOAT_EQ(PointWeight(4.0f, 1.0f, 0.5f), 1 / 272.0f);
    EXPECT_FLOAT_EQ(PointWeight(0.1f, 2.0f, 0.5f), 1 / 0.265625f);
    EXPECT_FLOAT_EQ(PointWeight(1.0f, 2.0f, 2.0f), 1 / 8.0f);
    EXPECT_FLOAT_EQ(PointWeight(0.1f, 0.0f, 0.5f), 1.0f);
    EXPECT_FLOAT_EQ(PointWeight(4.0f, 0.0f, 0.5f), 1.0f);
}

// Every image size has about as many points as 640 x 480 pixels, or fewer.
TEST(FinestStep, GrowsWithTheImage) {
    const auto step = [](int configured, int at_vga_px, int width, int height) {
        return FinestStep(configured, at_vga_px, {width, height, 500, 500, 0, 0});
    };
    EXPECT_EQ(step(0, 3, 640, 480), 3);
    EXPECT_EQ(step(0, 2, 640, 480), 2);
    EXPECT_EQ(step(0, 3, 848, 480), 3);
    EXPECT_EQ(step(0, 3, 1280, 720), 5);
    EXPECT_EQ(step(0, 3, 1920, 1080), 8);
    EXPECT_EQ(step(0, 3, 320, 240), 2);
    EXPECT_EQ(step(0, 3, 80, 60), 2);
    EXPECT_EQ(step(1, 3, 1920, 1080), 1);
    EXPECT_EQ(step(4, 3, 640, 480), 4);
    EXPECT_EQ(step(16, 3, 24, 20), 10);
    EXPECT_EQ(step(0, 3, 1, 1), 1);
}

// The default is 3 for every image of at least 64 x 48 pixels.
TEST(LevelsThatFit, LeaveSomethingOfTheImage) {
    const auto levels = [](int configured, int finest_step_px, int width, int height) {
        return LevelsThatFit(configured, finest_step_px, {width, height, 500, 500, 0, 0});
    };
    EXPECT_EQ(levels(3, 3, 640, 480), 3);
    EXPECT_EQ(levels(3, 2, 320, 240), 3);
    EXPECT_EQ(levels(3, 2, 80, 60), 3);
    EXPECT_EQ(levels(3, 2, 64, 48), 3);
    EXPECT_EQ(levels(5, 1, 160, 120), 5);
    EXPECT_EQ(levels(5, 16, 320, 240), 2);
    EXPECT_EQ(levels(5, 16, 160, 120), 1);
    EXPECT_EQ(levels(5, 4, 8, 8), 1);
}

// Moved is the exponential of the body twist to first order. A negative time inverts it.
TEST(PointKernels, MovedIsTheMotionToFirstOrder) {
    Vector6d twist;
    twist << 0.3, -0.2, 0.4, 0.1, 0.5, -0.3;
    const Eigen::Matrix<float, 6, 1> floats = twist.cast<float>();
    constexpr float kTime_s = 1e-3f;
    const Eigen::Vector3d exact = Se3Exp(kTime_s * twist) * Eigen::Vector3d(0.4, -0.3, 1.2);
    const CameraPoint moved = Moved({0.4f, -0.3f, 1.2f}, floats.data(), kTime_s);
    EXPECT_NEAR(moved.x, exact.x(), 3e-7);
    EXPECT_NEAR(moved.y, exact.y(), 3e-7);
    EXPECT_NEAR(moved.z, exact.z(), 3e-7);
    EXPECT_NEAR(Moved(moved, floats.data(), -kTime_s).x, 0.4, 3e-7);
}

// The plane z = 1 + x / 2 with a hole.
TEST(PointKernels, NormalOfAPlanePointsTowardsTheCamera) {
    PinholeImage image{nullptr, 9, 7, 20, 20, 4, 3};
    std::vector<float> depth;
    for (int i = 0; i < 63; ++i)
        depth.push_back(1.0f / (1.0f - 0.5f * static_cast<float>(i % 9 - 4) / 20.0f));
    depth[3 * 9 + 7] = 0;
    image.pixels = depth.data();
    CameraPoint n{};
    ASSERT_TRUE(NormalAt(image, 3, 3, 2, n));
    EXPECT_NEAR(n.x, 0.5 / std::sqrt(1.25), 1e-6);
    EXPECT_NEAR(n.y, 0, 1e-6);
    EXPECT_NEAR(n.z, -1 / std::sqrt(1.25), 1e-6);
    EXPECT_TRUE(NormalAt(image, 0, 6, 1, n));  // a corner, with one-sided differences
    EXPECT_FALSE(NormalAt(image, 5, 3, 2, n)) << "next to the hole";
    depth[3 * 9 + 1] = 3;
    EXPECT_FALSE(NormalAt(image, 3, 3, 2, n)) << "next to an edge";
}

TEST(PointKernels, ImagesAreReadBetweenPixelsAndNotOutside) {
    const float pixels[] = {0, 1, 2, 10, 11, 12, 20, 21, 22};
    const PinholeImage image{pixels, 3, 3, 100, 50, 1, 1};
    EXPECT_FLOAT_EQ(image.Between(0.5f, 1.25f), 13.0f);
    EXPECT_EQ(image.Between(-0.01f, 0), -1.0f);
    EXPECT_EQ(image.Between(1, 2), -1.0f);
    EXPECT_FLOAT_EQ(SampleAtPoint(image, {0.01f, -0.02f, 2}), 6.5f);  // pixel (1.5, 0.5)
    EXPECT_EQ(SampleAtPoint(image, {0, 0, -1}), -1.0f);
    EXPECT_FLOAT_EQ(RaySlope(7, 3.0, 8.0), 0.5f);
}

}  // namespace
}  // namespace tessera
