#include "io/colour_registration.h"

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

CameraCalibration TwoCameras() {
    CameraCalibration calibration;
    calibration.pinhole = {64, 48, 60, 60, 31.5, 23.5};
    ColourCamera& colour = calibration.colour.emplace();
    colour.pinhole = {100, 80, 95, 94, 49, 40};
    colour.T_colour_depth.linear() =
        Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
    colour.T_colour_depth.translation() = Eigen::Vector3d(0.05, -0.02, 0.01);
    return calibration;
}

// Brown and Conrady's model, written again.
Eigen::Vector2d DistortedPixel(const ColourCamera& camera, const Eigen::Vector3d& p) {
    const LensDistortion& d = camera.distortion;
    const double x = p.x() / p.z(), y = p.y() / p.z(), r = std::hypot(x, y);
    const double radial = 1 + d.k1 * std::pow(r, 2) + d.k2 * std::pow(r, 4) + d.k3 * std::pow(r, 6);
    return {camera.pinhole.cx +
                camera.pinhole.fx * (x * radial + 2 * d.p1 * x * y + d.p2 * (r * r + 2 * x * x)),
            camera.pinhole.cy +
                camera.pinhole.fy * (y * radial + d.p1 * (r * r + 2 * y * y) + 2 * d.p2 * x * y)};
}

void ExpectColoursOfPoints(const CameraCalibration& calibration) {
    const PinholeCamera& camera = calibration.pinhole;
    const ColourCamera& beside = *calibration.colour;
    DepthImage depth_m(camera.width, camera.height);
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x)
            depth_m(x, y) = 1 + 0.01f * static_cast<float>(x) + 0.02f * static_cast<float>(y);
    const DepthImage measured = depth_m;
    ColourImage colour;
    ColourRegistration(beside, camera)
        .Register(ColourRamp(beside.pinhole.width, beside.pinhole.height), depth_m, colour);
    int seen = 0, unseen = 0;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const Eigen::Vector3d p = camera.Unproject(x, y, measured(x, y));
            const Eigen::Vector2d at = DistortedPixel(beside, beside.T_colour_depth * p);
            const double last_x = beside.pinhole.width - 1, last_y = beside.pinhole.height - 1;
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
    CameraCalibration calibration = TwoCameras();
    calibration.colour->distortion = {0.2, -0.1, 0.01, -0.02, 0.05};
    ExpectColoursOfPoints(calibration);
}

// A depth pixel that is four colour pixels wide gets the mean of 4 x 4 of them.
TEST(ColourRegistration, LargeColourImagesAreAveraged) {
    const ColourCamera large{{128, 96, 120, 120, 63.5, 47.5}, {}};
    ColourImage raw = ColourRamp(128, 96, 4);
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) raw(x, y).b = (x + y) % 2 == 0 ? 200 : 100;
    DepthImage depth_m(32, 24);
    std::fill_n(depth_m.data(), depth_m.size(), 2.0f);
    ColourImage colour;
    ColourRegistration(large, {32, 24, 30, 30, 15.5, 11.5}).Register(raw, depth_m, colour);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            EXPECT_EQ(colour(x, y).b, 150);
            EXPECT_NEAR(colour(x, y).r, 2 * x + 0.75, 0.8);
            EXPECT_EQ(depth_m(x, y), 2);
        }
}

// A ramp's value says which colour pixel was taken.
TEST(MoveColour, TakesColourFromFartherRightAndDown) {
    for (const bool two : {false, true}) {
        CameraCalibration calibration = TwoCameras();
        if (!two) calibration.colour.reset();
        CameraCalibration moved = calibration;
        MoveColour({3, -2}, moved);
        const PinholeCamera& camera = calibration.pinhole;
        const ColourCamera before =
            calibration.colour.value_or(ColourCamera{camera, calibration.distortion});
        const ColourImage ramp = ColourRamp(before.pinhole.width, before.pinhole.height);
        DepthImage depth_m(camera.width, camera.height, 2.0f), same = depth_m;
        ColourImage was, is;
        ColourRegistration(before, camera).Register(ramp, same, was);
        ColourRegistration(*moved.colour, camera).Register(ramp, depth_m, is);
        const double scale = before.pinhole.fx / camera.fx;
        EXPECT_NEAR(is(30, 24).r - was(30, 24).r, 2 * 3 * scale, 1);
        EXPECT_NEAR(is(30, 24).g - was(30, 24).g, 3 * -2 * before.pinhole.fy / camera.fy, 1);
    }
    CameraCalibration still = TwoCameras();
    still.colour.reset();
    MoveColour(Eigen::Vector2d::Zero(), still);
    EXPECT_FALSE(still.colour);
}

TEST(CheckOneSize, ColourMustNotBeLarger) {
    CameraCalibration calibration = TwoCameras();
    EXPECT_NE(CheckOneSize(calibration).message().find("100 x 80"), std::string::npos);
    calibration.colour->pinhole = calibration.pinhole;
    EXPECT_TRUE(CheckOneSize(calibration).ok());
}

}  // namespace
}  // namespace tessera
