// The Kinect driver in the real OpenNI2 runtime, on a libfreenect without hardware.
#include <libfreenect.h>

#include <algorithm>

#include "io/openni_devices.h"
#include "openni/fake_freenect.h"
#include "openni/openni_fixture.h"

namespace tessera {
namespace {

using fake_freenect::Calls;
using fake_freenect::Plug;
using fake_freenect::Unplug;

class KinectDriver : public OpenniTest {
  protected:
    static bool Called(const std::string& call) {
        const std::vector<std::string> calls = Calls();
        return std::ranges::find(calls, call) != calls.end();
    }
    static std::string Off(freenect_flag flag) { return "flag " + std::to_string(flag) + " 0"; }
};

TEST_F(KinectDriver, DeliversRegisteredDepthAndColour) {
    Plug("A1");
    auto source = Open();
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(source->info().kind, "Microsoft Kinect (OpenNI2 camera)");
    EXPECT_NEAR(source->info().camera.fx, 525, 0.01);
    EXPECT_NEAR(source->info().camera.fy, 525, 0.01);
    EXPECT_NE(source->info().calibration_file.find("A1"), std::string::npos);
    const Log log = ReadFrames(*source, 4);
    ASSERT_EQ(log.frames.size(), 4u);
    EXPECT_EQ(log.Text(), "");
    ExpectIncreasingStamps(log.frames);
    for (const Frame& frame : log.frames) {
        const Image<std::uint16_t> depth = Millimetres(frame);
        const int number = depth(0, 0) - 1000;
        for (int y = 0; y < depth.height(); ++y)
            for (int x = 0; x < depth.width(); ++x) {
                ASSERT_EQ(depth(x, y), fake_freenect::PatternDepth_mm(number, x, y));
                const auto expected = [&](int c) {
                    return fake_freenect::PatternColour(number, x, y, c);
                };
                const auto& colour = frame.colour(x, y);
                ASSERT_EQ(colour.r, expected(0));
                ASSERT_EQ(colour.g, expected(1));
                ASSERT_EQ(colour.b, expected(2));
            }
    }
    EXPECT_TRUE(Called("depth registered"));
    EXPECT_TRUE(Called("colour"));
    EXPECT_TRUE(Called(Off(FREENECT_MIRROR_DEPTH)));
    EXPECT_TRUE(Called(Off(FREENECT_MIRROR_VIDEO)));
    source.reset();
    EXPECT_EQ(fake_freenect::OpenCameras(), 0);
    EXPECT_TRUE(Called("stop depth"));
    EXPECT_TRUE(Called("stop colour"));
    EXPECT_EQ(Calls().back(), "shutdown");
}

TEST_F(KinectDriver, SettingsReachTheCamera) {
    Plug("A1");
    OpenniConfig config;
    config.registration = config.auto_exposure = config.auto_white_balance = false;
    const auto source = Open("openni2:", config);
    ASSERT_NE(source, nullptr);
    EXPECT_NEAR(source->info().camera.fx, 575.8, 0.01);
    ASSERT_EQ(ReadFrames(*source, 3).frames.size(), 3u);
    EXPECT_TRUE(Called("depth mm"));
    EXPECT_TRUE(Called(Off(FREENECT_AUTO_EXPOSURE)));
    EXPECT_TRUE(Called(Off(FREENECT_AUTO_WHITE_BALANCE)));
}

TEST_F(KinectDriver, ACameraThatIsUnpluggedIsWaitedFor) {
    Plug("A1");
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    ASSERT_EQ(ReadFrames(*source, 2).frames.size(), 2u);
    Unplug("A1");
    Log log;
    for (int i = 0; i < 100 && log.messages.empty(); ++i) log = ReadFrames(*source, 1, 1);
    EXPECT_EQ(log.Text(), "camera unplugged, waiting for it\n");
    EXPECT_EQ(fake_freenect::OpenCameras(), 0);
    Plug("A1");
    log = ReadFrames(*source, 3, 40);
    EXPECT_EQ(log.Text(), "camera is back\n");
    EXPECT_EQ(log.frames.size(), 3u);
}

TEST_F(KinectDriver, OneOfTwoIsChosenByItsSerialNumber) {
    Plug("A1");
    Plug("B2");
    const OpenniListing listing = ListOpenniDevices();
    ASSERT_EQ(listing.devices.size(), 2u);
    const auto source = Open("openni2:freenect://B2");
    ASSERT_NE(source, nullptr);
    ASSERT_EQ(ReadFrames(*source, 1).frames.size(), 1u);
    EXPECT_TRUE(Called("open B2"));
    EXPECT_FALSE(Called("open A1"));
}

TEST_F(KinectDriver, WhatCannotBeOpenedIsRefused) {
    EXPECT_NE(OpenOpenniSource("openni2:", {}).message().find("no camera found"),
              std::string::npos);
    Plug("A1");
    fake_freenect::Occupy("A1");
    const auto source = OpenOpenniSource("openni2:freenect://A1", {});
    EXPECT_FALSE(source.ok());
    EXPECT_TRUE(source.message().starts_with("openni2:freenect://A1: ")) << source.message();
}

}  // namespace
}  // namespace tessera
