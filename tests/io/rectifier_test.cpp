#include "io/rectifier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace tessera {
namespace {

CameraCalibration Freiburg1() {
    return {
        {640, 480, 517.3, 516.5, 318.6, 255.3}, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}, 5000.0};
}

// The raw position of the ideal pixel (u, v) in the Brown-Conrady model, written out.
std::array<double, 2> Distort(const CameraCalibration& c, double u, double v) {
    const double x = (u - c.pinhole.cx) / c.pinhole.fx, y = (v - c.pinhole.cy) / c.pinhole.fy;
    const double r2 = x * x + y * y;
    const LensDistortion& d = c.distortion;
    const double radial = 1 + d.k1 * r2 + d.k2 * r2 * r2 + d.k3 * r2 * r2 * r2;
    const double xd = x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x);
    const double yd = y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y;
    return {xd * c.pinhole.fx + c.pinhole.cx, yd * c.pinhole.fy + c.pinhole.cy};
}

// Raw depth that encodes its own pixel.
Image<std::uint16_t> CountingDepth() {
    Image<std::uint16_t> raw(640, 480);
    for (std::size_t i = 0; i < raw.size(); ++i)
        raw.data()[i] = static_cast<std::uint16_t>(1 + i % 60000);
    return raw;
}

TEST(Rectifier, WithoutDistortionOnlyScalesDepth) {
    CameraCalibration calibration = Freiburg1();
    calibration.distortion = {};
    const Rectifier rectifier(calibration, {});
    EXPECT_FALSE(rectifier.active());
    Image<std::uint16_t> raw(640, 480, 5000);
    raw(0, 0) = 0;
    raw(1, 0) = 65535;
    DepthImage depth_m;
    rectifier.Depth(raw, depth_m);
    EXPECT_EQ(depth_m(0, 0), 0.0f);
    EXPECT_FLOAT_EQ(depth_m(1, 0), 13.107f);
    EXPECT_FLOAT_EQ(depth_m(639, 479), 1.0f);
    ColourImage colour(640, 480, {1, 2, 3}), same;
    rectifier.Colour(colour, same);
    EXPECT_EQ(colour, same);
}

TEST(Rectifier, SwitchedOffLeavesTheImages) {
    EXPECT_FALSE(Rectifier(Freiburg1(), {.correct_distortion = false}).active());
    EXPECT_TRUE(Rectifier(Freiburg1(), {}).active());
    EXPECT_FALSE(Rectifier(Freiburg1(), {.correct_distortion = false}).corrects_lens());
    EXPECT_TRUE(Rectifier(Freiburg1(), {}).corrects_lens());
    CameraCalibration ideal = Freiburg1();
    ideal.distortion = {};
    ideal.colour = ColourCamera{ideal.pinhole, {}, Eigen::Isometry3d::Identity()};
    EXPECT_TRUE(Rectifier(ideal, {}).active());
    EXPECT_FALSE(Rectifier(ideal, {}).corrects_lens());
    ideal.colour->distortion.k1 = 0.1;
    EXPECT_TRUE(Rectifier(ideal, {}).corrects_lens());
}

// What a lens with 30 % vignetting makes of an even grey, and of white.
TEST(Rectifier, EvensOutDarkCorners) {
    CameraCalibration calibration = Freiburg1();
    calibration.distortion = {};
    calibration.vignetting = 0.3;
    ColourImage raw(640, 480);
    for (int v = 0; v < 480; ++v)
        for (int u = 0; u < 640; ++u) {
            const double r = std::hypot(u - 319.5, v - 239.5) / std::hypot(319.5, 239.5);
            const auto grey = static_cast<std::uint8_t>(std::lround(180 * (1 - 0.3 * r * r)));
            raw(u, v) = {grey, 255, 0};
        }
    Frame frame;
    Rectifier rectifier(calibration, {});
    rectifier.Fill(Image<std::uint16_t>(640, 480, 5000), raw, frame);
    for (int v = 0; v < 480; v += 3)
        for (int u = 0; u < 640; u += 3) {
            EXPECT_NEAR(frame.colour(u, v).r, 180, 1.5) << u << ' ' << v;
            EXPECT_EQ(frame.colour(u, v).g, 255);
            EXPECT_EQ(frame.colour(u, v).b, 0);
        }
    ColourImage none;
    rectifier.Fill(Image<std::uint16_t>(640, 480, 5000), none, frame);
    EXPECT_TRUE(frame.colour.empty());
}

TEST(Rectifier, TakesTheInvalidValueOut) {
    for (bool correct : {false, true}) {
        const Rectifier rectifier(Freiburg1(),
                                  {.correct_distortion = correct, .invalid_depth = 65535});
        DepthImage depth_m;
        rectifier.Depth(Image<std::uint16_t>(640, 480, 65535), depth_m);
        EXPECT_TRUE(std::all_of(depth_m.data(), depth_m.data() + depth_m.size(),
                                [](float z) { return z == 0; }));
    }
}

TEST(Rectifier, DepthIsTheNearestRawPixelOfTheLensModel) {
    const CameraCalibration calibration = Freiburg1();
    const Image<std::uint16_t> raw = CountingDepth();
    DepthImage depth_m;
    Rectifier(calibration, {}).Depth(raw, depth_m);
    int outside = 0, compared = 0;
    for (int v = 0; v < 480; ++v)
        for (int u = 0; u < 640; ++u) {
            const auto [x, y] = Distort(calibration, u, v);
            // Within a thousandth of a pixel of a pixel border, either neighbour is right.
            if (std::abs(x - std::floor(x) - 0.5) < 1e-3 ||
                std::abs(y - std::floor(y) - 0.5) < 1e-3)
                continue;
            const int column = static_cast<int>(std::lround(x)),
                      row = static_cast<int>(std::lround(y));
            const float expected_m =
                raw.Contains(column, row) ? static_cast<float>(raw(column, row)) / 5000.0f : 0.0f;
            ASSERT_NEAR(depth_m(u, v), expected_m, 1e-5f) << u << " " << v;
            outside += expected_m == 0;
            ++compared;
        }
    EXPECT_GT(compared, 300000);
    EXPECT_GT(outside, 0);
}

TEST(Rectifier, NeverMixesDepths) {
    Image<std::uint16_t> raw(640, 480);
    for (int v = 0; v < 480; ++v)
        for (int u = 0; u < 640; ++u) raw(u, v) = (u / 7 + v / 5) % 2 == 0 ? 5000 : 10000;
    DepthImage depth_m;
    Rectifier(Freiburg1(), {}).Depth(raw, depth_m);
    const std::set<float> values(depth_m.data(), depth_m.data() + depth_m.size());
    for (float z : values)
        EXPECT_TRUE(z == 0.0f || std::abs(z - 1) < 1e-6f || std::abs(z - 2) < 1e-6f) << z;
}

TEST(Rectifier, ColourIsBilinearAtTheLensModelsPlace) {
    const CameraCalibration calibration = Freiburg1();
    ColourImage raw(640, 480);
    for (int v = 0; v < 480; ++v)
        for (int u = 0; u < 640; ++u)
            raw(u, v) = {static_cast<std::uint8_t>(u * 255 / 639),
                         static_cast<std::uint8_t>(v * 255 / 479),
                         static_cast<std::uint8_t>((u + v) % 2 * 40)};
    ColourImage rectified;
    Rectifier(calibration, {}).Colour(raw, rectified);
    for (int v = 0; v < 480; ++v)
        for (int u = 0; u < 640; ++u) {
            const auto [x, y] = Distort(calibration, u, v);
            if (x < 0 || y < 0 || x >= 639 || y >= 479) continue;
            const int c = static_cast<int>(x), r = static_cast<int>(y);
            const double a = x - c, b = y - r;
            const auto mix = [&](auto channel) {
                return (1 - b) * ((1 - a) * channel(raw(c, r)) + a * channel(raw(c + 1, r))) +
                       b * ((1 - a) * channel(raw(c, r + 1)) + a * channel(raw(c + 1, r + 1)));
            };
            // OpenCV rounds positions to 1/32 pixel. On the 40-level checkerboard of the blue
            // channel that is up to 2.5 levels, plus rounding.
            ASSERT_NEAR(rectified(u, v).r, mix([](Rgb8 p) { return p.r; }), 1.01) << u << " " << v;
            ASSERT_NEAR(rectified(u, v).g, mix([](Rgb8 p) { return p.g; }), 1.01) << u << " " << v;
            ASSERT_NEAR(rectified(u, v).b, mix([](Rgb8 p) { return p.b; }), 3.5) << u << " " << v;
        }
}

}  // namespace
}  // namespace tessera
