#include "io/openni_source.h"

#include "io/temporary_folder.h"
#include "openni/openni_fixture.h"

namespace tessera {
namespace {

using OpenniSource = OpenniTest;

TEST_F(OpenniSource, SaysWhatTheCameraIs) {
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const SourceInfo& info = source->info();
    EXPECT_EQ(info.name, "openni2:");
    EXPECT_EQ(info.kind, "Tessera Test camera (OpenNI2 camera)");
    EXPECT_TRUE(info.live);
    EXPECT_EQ(info.depth_units_per_m, 1000);
    EXPECT_EQ(info.frame_count, -1);
    EXPECT_EQ(info.fps, 30);
    EXPECT_TRUE(info.notes.empty()) << info.notes.front();
    EXPECT_EQ(info.camera.width, 640);
    EXPECT_EQ(info.camera.height, 480);
    EXPECT_NEAR(info.camera.fx, 525, 1e-3);  // the fields of view are stored as float
    EXPECT_NEAR(info.camera.fy, 525, 1e-3);
    EXPECT_EQ(info.camera.cx, 319.5);
    EXPECT_EQ(info.camera.cy, 239.5);
    EXPECT_FALSE(source->Seek(0));
}

TEST_F(OpenniSource, GivesWhatTheDeviceServedBitForBit) {
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 12);
    ASSERT_EQ(log.frames.size(), 12u);
    EXPECT_TRUE(log.skips.empty());
    EXPECT_TRUE(log.messages.empty());
    for (int i = 0; i < 12; ++i) {
        const Frame& frame = log.frames[static_cast<std::size_t>(i)];
        EXPECT_EQ(frame.index, i);
        EXPECT_DOUBLE_EQ(frame.stamp_s,
                         1e-6 * static_cast<double>(1000000 + std::llround(1e6 * i / 30)));
        EXPECT_EQ(frame.colour_stamp_s, frame.stamp_s);
        EXPECT_EQ(Millimetres(frame), ExpectedDepth(i));
        EXPECT_EQ(frame.depth_m(5, 7),
                  static_cast<float>(test_device::PatternDepth(i, 5, 7)) / 1000.0f);
        EXPECT_EQ(frame.colour, ExpectedColour(i));
    }
}

TEST_F(OpenniSource, TheConfiguredIntrinsicsComeFirst) {
    OpenniConfig config;
    config.fx = 500;
    config.cy = 250;
    const auto source = Open("openni2:", config);
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(source->info().camera.fx, 500);
    EXPECT_NEAR(source->info().camera.fy, 525, 1e-3);
    EXPECT_EQ(source->info().camera.cx, 319.5);
    EXPECT_EQ(source->info().camera.cy, 250);
}

TEST_F(OpenniSource, TheCalibrationOfItsSerialNumberIsUsed) {
    const TemporaryFolder folder;
    setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
    const std::string path = folder.Path("tessera/cameras/TEST_0042.yaml");
    EXPECT_EQ(Open()->info().calibration_file, path);
    const std::string camera =
        "width: 640\nheight: 480\nfx: 510\nfy: 511\ncx: 320\ncy: 240\n"
        "distortion: [0.1, 0, 0, 0, 0]\ndepth_scale: 990\n";
    folder.WriteText("tessera/cameras/TEST_0042.yaml", camera);
    OpenniConfig config;
    config.cy = 250;
    auto source = Open("openni2:", config);
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(source->info().camera, (PinholeCamera{640, 480, 510, 511, 320, 250}));
    EXPECT_TRUE(source->info().rectified);
    EXPECT_EQ(source->info().depth_units_per_m, 990);
    EXPECT_EQ(source->info().notes, std::vector<std::string>{"calibration from " + path});
    const Log log = ReadFrames(*source, 1);
    ASSERT_EQ(log.frames.size(), 1u);
    // The principal point does not move.
    EXPECT_EQ(log.frames[0].depth_m(320, 250),
              static_cast<float>(test_device::PatternDepth(0, 320, 250)) / 990.0f);
    EXPECT_NE(log.frames[0].colour, ExpectedColour(0));
    source.reset();

    config.calibration = "none";
    EXPECT_EQ(Open("openni2:", config)->info().depth_units_per_m, 1000);
    config.calibration = folder.Path("absent.yaml");
    EXPECT_NE(OpenOpenniSource("openni2:", config).message().find("absent.yaml"),
              std::string::npos);
    config.calibration = "";
    folder.WriteText("tessera/cameras/TEST_0042.yaml", kSmallCamera);
    EXPECT_NE(OpenOpenniSource("openni2:", config)
                  .message()
                  .find("is for images of 32 x 24, but the camera delivers 640 x 480"),
              std::string::npos);
}

TEST_F(OpenniSource, SetsTheDeviceUp) {
    TemporaryFolder folder;
    Set("LOG", folder.Path("log"));
    OpenniConfig config;
    config.auto_exposure = false;
    ASSERT_NE(Open("openni2:", config), nullptr);
    const std::string log = ReadText(folder.Path("log"));
    for (const char* line : {"registration 1\n", "depth mirror 0\n", "colour mirror 0\n",
                             "colour auto_exposure 0\n", "colour auto_white_balance 1\n"})
        EXPECT_NE(log.find(line), std::string::npos) << line << "in\n" << log;
}

TEST_F(OpenniSource, TakesTheNearestSizeThatTheDeviceHas) {
    Set("SMALL", 1);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    ASSERT_EQ(source->info().notes.size(), 1u);
    EXPECT_EQ(source->info().notes[0],
              "320 x 240 pixels, depth at 30 and colour at 30 frames per second (requested: 640 x "
              "480 at 30)");
    EXPECT_NEAR(source->info().camera.fx, 262.5, 1e-3);
    EXPECT_EQ(source->info().camera.cx, 159.5);
    const Log log = ReadFrames(*source, 2);
    ASSERT_EQ(log.frames.size(), 2u);
    EXPECT_EQ(Millimetres(log.frames[1]), ExpectedDepth(1, 2));
}

TEST_F(OpenniSource, SaysWhenDepthIsNotRegistered) {
    Set("REGISTRATION", 0);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    ASSERT_EQ(source->info().notes.size(), 1u);
    EXPECT_NE(source->info().notes[0].find("does not register"), std::string::npos);
}

TEST_F(OpenniSource, FramesOfTheSameMomentComeWithFrameSync) {
    Set("SYNC", 1);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 5);
    ASSERT_EQ(log.frames.size(), 5u);
    EXPECT_EQ(Millimetres(log.frames[4]), ExpectedDepth(NumberOf(log.frames[4])));
}

TEST_F(OpenniSource, FrameSyncThatGivesNothingIsTurnedOff) {
    Set("SYNC", 1);
    Set("DROP", 100);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 1, 4);
    ASSERT_EQ(log.messages.size(), 1u);
    EXPECT_NE(log.messages[0].find("trying without frame sync"), std::string::npos)
        << log.messages[0];
}

TEST_F(OpenniSource, DevicesAreFoundByTheirUri) {
    Set("COUNT", 2);
    const auto source = Open("openni2:test://1");
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(ReadFrames(*source, 1).frames.size(), 1u);
    const auto other = OpenOpenniSource("openni2:test://7", {});
    EXPECT_EQ(other.message(),
              "openni2:test://7: no such camera; tessera doctor lists the cameras");
}

TEST_F(OpenniSource, TwoCamerasAtATime) {
    Set("COUNT", 2);
    auto first = Open("openni2:test://0");
    const auto second = Open("openni2:test://1");
    ASSERT_TRUE(first && second);
    EXPECT_EQ(ReadFrames(*first, 2).frames.size(), 2u);
    first.reset();  // the runtime stays initialised
    EXPECT_EQ(ReadFrames(*second, 3).frames.size(), 3u);
}

TEST_F(OpenniSource, NoCameraSaysWhatToDo) {
    Set("COUNT", 0);
    EXPECT_EQ(OpenOpenniSource("openni2:", {}).message(),
              "openni2:: no camera found; is it plugged in, and do you have permission to "
              "use it? tessera doctor gives details");
}

TEST_F(OpenniSource, RunsByTheClock) {
    Set("PACE", "real");
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 10);
    ASSERT_EQ(log.frames.size(), 10u);
    ExpectIncreasingStamps(log.frames);
    for (const Frame& frame : log.frames)
        EXPECT_EQ(Millimetres(frame), ExpectedDepth(NumberOf(frame)));
}

}  // namespace
}  // namespace tessera
