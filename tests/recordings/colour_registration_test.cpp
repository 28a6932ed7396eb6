#include "recordings/colour_registration.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera {
namespace {

// Colour that says where it is: red is 2 u, green is 3 v.
ColourImage ColourRamp(int width, int height, int scale = 1) {
    ColourImage image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image(x, y) = {static_cast<std::uint8_t>(2 * x / scale),
                           static_cast<std::uint8_t>(3 * y / scale), 7};
    return image;
}

RecordingInfo TwoCameras() {
    RecordingInfo info;
    info.depth_camera.pinhole = {64, 48, 60, 60, 31.5, 23.5};
    info.colour_camera.pinhole = {100, 80, 95, 94, 49, 40};
    info.T_colour_depth.linear() =
        Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
    info.T_colour_depth.translation() = Eigen::Vector3d(0.05, -0.02, 0.01);
    return info;
}

// Brown and Conrady's model, written again.
Eigen::Vector2d DistortedPixel(const CameraCalibration& camera, const Eigen::Vector3d& p) {
    const LensDistortion& d = camera.distortion;
    const double x = p.x() / p.z(), y = p.y() / p.z(), r = std::hypot(x, y);
    const double radial = 1 + d.k1 * std::pow(r, 2) + d.k2 * std::pow(r, 4) + d.k3 * std::pow(r, 6);
    return {camera.pinhole.cx +
                camera.pinhole.fx * (x * radial + 2 * d.p1 * x * y + d.p2 * (r * r + 2 * x * x)),
            camera.pinhole.cy +
                camera.pinhole.fy * (y * radial + d.p1 * (r * r + 2 * y * y) + 2 * d.p2 * x * y)};
}

void ExpectColoursOfPoints(const RecordingInfo& info) {
    const PinholeCamera& camera = info.depth_camera.pinhole;
    DepthImage depth_m(camera.width, camera.height);
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x)
            depth_m(x, y) = 1 + 0.01f * static_cast<float>(x) + 0.02f * static_cast<float>(y);
    const DepthImage measured = depth_m;
    ColourImage colour;
    ColourRegistration(info, camera)
        .Register(ColourRamp(info.colour_camera.pinhole.width, info.colour_camera.pinhole.height),
                  depth_m, colour);
    int seen = 0, unseen = 0;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const Eigen::Vector3d p = camera.Unproject(x, y, measured(x, y));
            const Eigen::Vector2d at = DistortedPixel(info.colour_camera, info.T_colour_depth * p);
            const double last_x = info.colour_camera.pinhole.width - 1,
                         last_y = info.colour_camera.pinhole.height - 1;
            if (at.x() < -0.6 || at.y() < -0.6 || at.x() > last_x + 0.6 || at.y() > last_y + 0.6) {
                ++unseen;
                EXPECT_EQ(depth_m(x, y), 0) << x << ' ' << y;
            } else if (at.x() > 0 && at.y() > 0 && at.x() < last_x && at.y() < last_y) {
                ++seen;
                EXPECT_EQ(depth_m(x, y), measured(x, y));
                EXPECT_NEAR(colour(x, y).r, 2 * at.x(), 0.6);
                EXPECT_NEAR(colour(x, y).g, 3 * at.y(), 0.6);
            }
        }
    EXPECT_GT(seen, 1000);
    EXPECT_GT(unseen, 50);
}

TEST(ColourRegistration, APointGetsTheColourThatIsSeenThere) {
    ExpectColoursOfPoints(TwoCameras());
}

TEST(ColourRegistration, TheColourLensIsCorrected) {
    RecordingInfo info = TwoCameras();
    info.colour_camera.distortion = {0.2, -0.1, 0.01, -0.02, 0.05};
    ExpectColoursOfPoints(info);
}

// A depth pixel that is four colour pixels wide gets the mean of 4 x 4 of them.
TEST(ColourRegistration, LargeColourImagesAreAveraged) {
    RecordingInfo info;
    info.depth_camera.pinhole = {32, 24, 30, 30, 15.5, 11.5};
    info.colour_camera.pinhole = {128, 96, 120, 120, 63.5, 47.5};
    EXPECT_FALSE(IsRegistered(info));
    ColourImage raw = ColourRamp(128, 96, 4);
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) raw(x, y).b = (x + y) % 2 == 0 ? 200 : 100;
    DepthImage depth_m(32, 24);
    std::fill_n(depth_m.data(), depth_m.size(), 2.0f);
    ColourImage colour;
    ColourRegistration(info, info.depth_camera.pinhole).Register(raw, depth_m, colour);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            EXPECT_EQ(colour(x, y).b, 150);
            EXPECT_NEAR(colour(x, y).r, 2 * x + 0.75, 0.8);
            EXPECT_EQ(depth_m(x, y), 2);
        }
}

TEST(ColourRegistration, OneCameraNeedsNone) {
    RecordingInfo info;
    info.depth_camera.pinhole = info.colour_camera.pinhole = {64, 48, 60, 60, 31.5, 23.5};
    EXPECT_TRUE(IsRegistered(info));
    info.T_colour_depth.translation().x() = 0.01;
    EXPECT_FALSE(IsRegistered(info));
}

}  // namespace
}  // namespace tessera
