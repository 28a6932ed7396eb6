#include "recordings/k4a_calibration.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "recordings/k4a_device.h"

namespace tessera {
namespace {

K4aCalibration K4aDeviceCalibration() {
    Result<K4aCalibration> parsed = ParseK4aCalibration(kK4aDevice);
    EXPECT_TRUE(parsed.ok()) << parsed.message();
    return parsed.value();
}

std::string K4aDeviceWith(const std::string& from, const std::string& to) {
    std::string text = kK4aDevice;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

// As colour_registration.cpp does.
Eigen::Vector2d ProjectK4a(const CameraCalibration& camera, const Eigen::Vector3d& p_camera) {
    const LensDistortion& d = camera.distortion;
    const double x = p_camera.x() / p_camera.z(), y = p_camera.y() / p_camera.z();
    const double r2 = x * x + y * y, radial = 1 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
    return camera.pinhole.Project({x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x),
                                   y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y, 1});
}

void ExpectK4aPinhole(const PinholeCamera& camera, double fx, double fy, double cx, double cy) {
    EXPECT_NEAR(camera.fx, fx, 1e-3);
    EXPECT_NEAR(camera.fy, fy, 1e-3);
    EXPECT_NEAR(camera.cx, cx, 1e-3);
    EXPECT_NEAR(camera.cy, cy, 1e-3);
}

// Another real device: the numbers of its file, and what the SDK made of them for 640 x 576 and
// 1920 x 1080 pixels. Published in github.com/panispani/3DReconstruct, pointCloudGen/calib.md.
TEST(K4aCalibration, ModesHaveTheIntrinsicsThatTheSdkPrints) {
    K4aCalibration device;
    device.depth.cx = 0.5122697949409485;
    device.depth.cy = 0.49451231956481934;
    device.depth.fx = 0.4921168386936188;
    device.depth.fy = 0.4921667277812958;
    device.colour.cx = 0.4967627227306366;
    device.colour.cy = 0.5108628273010254;
    device.colour.fx = 0.470907062292099;
    device.colour.fy = 0.6274453997612;
    const auto cameras = MakeK4aCameras(device, {640, 576}, {1920, 1080});
    ASSERT_TRUE(cameras.ok()) << cameras.message();
    ExpectK4aPinhole(cameras.value().depth.pinhole, 503.927643, 503.978729, 332.064270, 325.880615);
    ExpectK4aPinhole(cameras.value().colour.pinhole, 904.141541, 903.521362, 953.284424,
                     555.142456);
    EXPECT_EQ(cameras.value().depth.pinhole.width, 640);
    EXPECT_EQ(cameras.value().depth.pinhole.height, 576);
    EXPECT_EQ(cameras.value().depth.depth_scale, 1000);
    EXPECT_EQ(cameras.value().colour.pinhole.width, 1920);
    EXPECT_EQ(cameras.value().colour.pinhole.height, 1080);
}

// By hand. Half the size: a pixel's centre c becomes (c + 0.5) / 2 - 0.5.
TEST(K4aCalibration, OtherModes) {
    const K4aCalibration device = K4aDeviceCalibration();
    const auto whole = MakeK4aCameras(device, {1024, 1024}, {4096, 3072});
    ASSERT_TRUE(whole.ok()) << whole.message();
    ExpectK4aPinhole(whole.value().depth.pinhole, 504.60764, 504.73251, 524.78107, 528.82971);
    ExpectK4aPinhole(whole.value().colour.pinhole, 1957.74512, 1958.16632, 2046.87390, 1555.82928);
    const auto halved = MakeK4aCameras(device, {512, 512}, {2048, 1536});
    ASSERT_TRUE(halved.ok()) << halved.message();
    ExpectK4aPinhole(halved.value().depth.pinhole, 252.30382, 252.36626, 262.14053, 264.16486);
    ExpectK4aPinhole(halved.value().colour.pinhole, 978.87256, 979.08316, 1023.18695, 777.66464);
    const auto narrow = MakeK4aCameras(device, {320, 288}, {1280, 720});
    ASSERT_TRUE(narrow.ok()) << narrow.message();
    ExpectK4aPinhole(narrow.value().depth.pinhole, 252.30382, 252.36626, 166.14053, 174.16486);
    ExpectK4aPinhole(narrow.value().colour.pinhole, 611.79535, 611.92698, 639.30434, 365.85290);
    for (const ImageSize colour : {ImageSize{2560, 1440}, ImageSize{3840, 2160}})
        EXPECT_TRUE(MakeK4aCameras(device, {640, 576}, colour).ok());
}

// The SDK's own results for this device, from pyk4a's tests/unit/test_calibration.py, in mm.
TEST(K4aCalibration, ColourCameraSeesPointsWhereTheSdkSaysItDoes) {
    const K4aCalibration device = K4aDeviceCalibration();
    const auto cameras = MakeK4aCameras(device, {640, 576}, {1280, 720});
    ASSERT_TRUE(cameras.ok()) << cameras.message();
    const Eigen::Vector3d in_depth_mm(1031.4664306640625, 1325.8529052734375, 2117.6611328125);
    const Eigen::Vector3d in_colour_m = cameras.value().T_colour_depth * (in_depth_mm / 1000);
    EXPECT_LT((in_colour_m - Eigen::Vector3d(1, 1.5, 2)).norm(), 1e-6);

    const Eigen::Vector3d other_depth_mm(-122.29087829589844, -45.17741394042969,
                                         243.19528198242188);
    const Eigen::Vector3d other_m = cameras.value().T_colour_depth * (other_depth_mm / 1000);
    EXPECT_LT((other_m - Eigen::Vector3d(-0.1545365753, -0.0261217117, 0.25)).norm(), 1e-6);
    const Eigen::Vector2d pixel(250, 300);
    const Eigen::Vector2d exact = cameras.value().colour.pinhole.Project(
        device.colour.Distort(other_m.hnormalized()).homogeneous());
    EXPECT_LT((exact - pixel).norm(), 1e-3);
    EXPECT_LT((ProjectK4a(cameras.value().colour, other_m) - pixel).norm(), 0.2);
}

// For all pixels that are used, not only those of the fit.
TEST(K4aCalibration, LensesAreAsCloseAsIsSaid) {
    const K4aCalibration device = K4aDeviceCalibration();
    for (const ImageSize size : {ImageSize{640, 576}, ImageSize{1024, 1024}, ImageSize{512, 512}}) {
        const auto cameras = MakeK4aCameras(device, size, {1920, 1080});
        ASSERT_TRUE(cameras.ok());
        const K4aCameras& c = cameras.value();
        const bool narrow = size.width == 640;
        EXPECT_LT(c.depth_error_px, narrow ? 0.05 : 0.7);
        EXPECT_LT(c.colour_error_px, narrow ? 0.4 : 1.5);
        double depth_px = 0, colour_px = 0;
        for (int v = 0; v < size.height; v += 3)
            for (int u = 0; u < size.width; u += 3) {
                const Eigen::Vector3d p_depth = c.depth.pinhole.Unproject(u, v, 1.3);
                const Eigen::Vector2d seen = c.depth.pinhole.Project(
                    device.depth.Distort(p_depth.hnormalized()).homogeneous());
                depth_px = std::max(depth_px, (seen - ProjectK4a(c.depth, p_depth)).norm());
                const Eigen::Vector3d p_colour = c.T_colour_depth * p_depth;
                const Eigen::Vector2d at = c.colour.pinhole.Project(
                    device.colour.Distort(p_colour.hnormalized()).homogeneous());
                const Eigen::Vector2d fitted = ProjectK4a(c.colour, p_colour);
                const auto inside = [](const Eigen::Vector2d& p) {
                    return p.x() >= 0 && p.y() >= 0 && p.x() < 1920 && p.y() < 1080;
                };
                if (inside(at) || inside(fitted))
                    colour_px = std::max(colour_px, (fitted - at).norm());
            }
        EXPECT_LT(depth_px, 1.1 * c.depth_error_px + 0.01) << size.width;
        EXPECT_LT(colour_px, 1.1 * c.colour_error_px + 0.01) << size.width;
    }
}

// The SDK's tests/UnitTests/utcommon/inc/ut_calibration_data.h has such a device: its numbers are
// parts of 3840 x 2160 pixels.
TEST(K4aCalibration, AnEarlyDeviceHasItsNumbersForTheMiddleRows) {
    std::string text = K4aDeviceWith(
        "0.49984714388847351, 0.50661760568618774, "
        "0.47796511650085449, 0.63742393255233765",
        "0.49626153707504272, 0.50453948974609375, "
        "0.48109495639801025, 0.85502892732620239");
    text.replace(text.find("3072"), 4, "2160");
    text.replace(text.find("4096"), 4, "3840");
    const auto device = ParseK4aCalibration(text);
    ASSERT_TRUE(device.ok()) << device.message();
    const auto cameras = MakeK4aCameras(device.value(), {640, 576}, {3840, 2160});
    ASSERT_TRUE(cameras.ok());
    ExpectK4aPinhole(cameras.value().colour.pinhole, 0.48109495639801025 * 3840,
                     0.85502892732620239 * 2160, 0.49626153707504272 * 3840 - 0.5,
                     0.50453948974609375 * 2160 - 0.5);
}

TEST(K4aCalibration, TheEarlyLensModelHasHalfTheMixedTerms) {
    const std::string text = K4aDeviceWith("BrownConrady", "Rational6KT");
    const auto early = ParseK4aCalibration(text);
    ASSERT_TRUE(early.ok()) << early.message();
    const K4aCamera later = K4aDeviceCalibration().depth;
    const Eigen::Vector2d p(0.4, -0.3);
    const Eigen::Vector2d difference = later.Distort(p) - early.value().depth.Distort(p);
    EXPECT_NEAR(difference.x(), 2.0557534298859537E-5 * 0.4 * -0.3, 1e-12);
    EXPECT_NEAR(difference.y(), -7.2104157879948616E-5 * 0.4 * -0.3, 1e-12);
}

TEST(K4aCalibration, AUsualDeviceIsLikeARealOne) {
    const auto usual = MakeK4aCameras(UsualK4aCalibration(), {640, 576}, {1920, 1080});
    const auto real = MakeK4aCameras(K4aDeviceCalibration(), {640, 576}, {1920, 1080});
    ASSERT_TRUE(usual.ok() && real.ok());
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(-0.5, 0.5, 1), Eigen::Vector3d(0.5, -0.4, 1)}) {
        EXPECT_LT((ProjectK4a(usual.value().depth, p) - ProjectK4a(real.value().depth, p)).norm(),
                  25);
        EXPECT_LT((ProjectK4a(usual.value().colour, usual.value().T_colour_depth * p) -
                   ProjectK4a(real.value().colour, real.value().T_colour_depth * p))
                      .norm(),
                  15);
    }
}

TEST(K4aCalibration, WhatIsNoModeOrNoCalibrationIsRefused) {
    const K4aCalibration device = K4aDeviceCalibration();
    const auto no_depth = MakeK4aCameras(device, {640, 480}, {1280, 720});
    ASSERT_FALSE(no_depth.ok());
    EXPECT_NE(no_depth.message().find("depth of 640 x 480"), std::string::npos);
    for (const ImageSize colour : {ImageSize{1280, 700}, ImageSize{1000, 750}, ImageSize{-16, 0}})
        EXPECT_FALSE(MakeK4aCameras(device, {640, 576}, colour).ok()) << colour.width;
    EXPECT_FALSE(ParseK4aCalibration("").ok());
    EXPECT_FALSE(ParseK4aCalibration("{}").ok());
    EXPECT_FALSE(ParseK4aCalibration(std::string(100000, '[')).ok());
    for (const auto& [from, to] : {std::pair{"BrownConrady", "Theta"},
                                   {"LocationD0", "LocationD1"},
                                   {"LocationPV0", "Location"},
                                   {"[1, 0, 0, 0, 1", "[2, 0, 0, 0, 1"},
                                   {"[1, 0, 0, 0, 1", "[-1, 0, 0, 0, 1"},
                                   {"[1, 0, 0, 0, 1", "[0, 0, 0, 1"},
                                   {"-0.032083429396152496", "-32.0"},
                                   {"0.54793977737426758", "1e300"},
                                   {"0.54793977737426758", "\"x\""},
                                   {"-0.00012944525224156678,", ""},
                                   {"\"SensorWidth\": 1024", "\"SensorWidth\": 1023"},
                                   {"\"SensorWidth\": 4096", "\"SensorWidth\": 1e300"},
                                   {"\"Rt\"", "\"R\""}}) {
        const auto parsed = ParseK4aCalibration(K4aDeviceWith(from, to));
        EXPECT_FALSE(parsed.ok()) << from << " -> " << to;
        EXPECT_FALSE(parsed.message().empty());
    }
}

TEST(K4aCalibration, DamagedTextIsAnErrorOrACalibration) {
    std::mt19937 random(14);
    for (int i = 0; i < 500; ++i) {
        std::string text = kK4aDevice;
        for (int k = 0; k < 3; ++k)
            text[random() % text.size()] = static_cast<char>(random() % 256);
        const auto parsed = ParseK4aCalibration(text);
        if (!parsed.ok()) continue;
        EXPECT_TRUE(MakeK4aCameras(parsed.value(), {640, 576}, {1280, 720}).ok());
    }
}

}  // namespace
}  // namespace tessera
