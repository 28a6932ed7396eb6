#include "recordings/mkv_recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "recordings/k4a_device.h"
#include "recordings/mkv_fixture.h"
#include "recordings/recording_source.h"

namespace tessera {
namespace {

class MkvRecordings : public MkvFixture {};

TEST_F(MkvRecordings, ImagesStampsAndCameras) {
    const auto recording = WriteAndOpen();
    ASSERT_TRUE(recording.ok()) << recording.message();
    const RecordingInfo& info = recording.value()->info();
    EXPECT_EQ(info.kind, "Azure Kinect recording");
    EXPECT_TRUE(info.camera_known);
    EXPECT_TRUE(info.notes.empty()) << info.notes[0];
    EXPECT_TRUE(info.warnings.empty()) << info.warnings[0];
    EXPECT_DOUBLE_EQ(info.fps, 25);
    ASSERT_EQ(info.pairs.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        const double stamp_s = 0.1 + 0.04 * static_cast<double>(i);
        EXPECT_NEAR(info.pairs[i].depth_stamp_s, stamp_s, 1e-9);
        EXPECT_NEAR(info.pairs[i].colour_stamp_s, stamp_s + 0.005, 1e-9);
        ExpectPair(*recording.value(), i, static_cast<int>(i), static_cast<int>(i));
    }
    // The depth sensor at half its size, without 96 columns and 90 rows.
    EXPECT_NEAR(info.depth_camera.pinhole.fx, 0.4927808940 * 512, 1e-6);
    EXPECT_NEAR(info.depth_camera.pinhole.cx, 0.5129697919 * 512 - 96 - 0.5, 1e-6);
    EXPECT_NEAR(info.depth_camera.pinhole.cy, 0.5169235468 * 512 - 90 - 0.5, 1e-6);
    EXPECT_EQ(info.depth_camera.depth_scale, 1000);
    EXPECT_LT(info.depth_camera.distortion.k1, -0.2);
    // 720 of the colour sensor's 960 rows.
    EXPECT_NEAR(info.colour_camera.pinhole.fx, 0.4779651165 * 1280, 1e-6);
    EXPECT_NEAR(info.colour_camera.pinhole.fy, 0.6374239326 * 960, 1e-6);
    EXPECT_NEAR(info.colour_camera.pinhole.cy, 0.5066176057 * 960 - 120 - 0.5, 1e-6);
    EXPECT_NEAR(info.T_colour_depth.translation().x(), -0.0320834, 1e-6);
}

TEST_F(MkvRecordings, AnyOrder) {
    const auto recording = WriteAndOpen();
    ASSERT_TRUE(recording.ok()) << recording.message();
    for (const int i : {3, 3, 5, 0, 4, 1, 2, 0}) ExpectPair(*recording.value(), i, i, i);
}

TEST_F(MkvRecordings, AFileWrittenWithoutSizesAndIndex) {
    recipe.streamed = true;
    const auto recording = WriteAndOpen();
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_TRUE(recording.value()->info().warnings.empty());
    EXPECT_TRUE(recording.value()->info().camera_known);
    ASSERT_EQ(recording.value()->info().pairs.size(), 6u);
    for (const int i : {5, 0, 3}) ExpectPair(*recording.value(), i, i, i);
}

TEST_F(MkvRecordings, DepthIsFoundByItsTagUnderAnotherName) {
    recipe.depth_name = "Tiefe";
    WriteMkv(folder, "a.mkv", recipe);
    ExpectRefused("plain video");
    // Tags of the track's number, as k4arecorder writes them. ffmpeg chooses the number.
    const std::string bytes = Bytes(), uid_head = {0x73, '\xc5', '\x88'};
    const std::size_t uid = bytes.find(uid_head, bytes.find(uid_head) + 1);
    ASSERT_NE(uid, std::string::npos);
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < 8; ++i)
        number = number << 8 | static_cast<std::uint8_t>(bytes[uid + 3 + i]);
    recipe.tags.push_back("K4A_DEPTH_TRACK=" + std::string(20, '0'));
    WriteMkv(folder, "a.mkv", recipe);
    std::string tagged = Bytes();
    const std::size_t again = tagged.find(uid_head, tagged.find(uid_head) + 1);
    tagged.replace(again, 11, bytes, uid, 11);  // ffmpeg takes other numbers each time
    std::string text = std::to_string(number);
    text.resize(20, '\0');
    tagged.replace(tagged.find(std::string(20, '0')), 20, text);
    folder.WriteText("a.mkv", tagged);
    const auto recording = Open();
    ASSERT_TRUE(recording.ok()) << recording.message();
    ExpectPair(*recording.value(), 2, 2, 2);
}

TEST_F(MkvRecordings, DepthWithoutColour) {
    recipe.colour_count = 0;
    const auto recording = WriteAndOpen();
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_TRUE(Mentions(recording.value()->info().notes, "no colour"));
    EXPECT_FALSE(recording.value()->info().has_colour);
    ASSERT_EQ(recording.value()->info().pairs.size(), 6u);
    ASSERT_TRUE(recording.value()->Load(4, depth, colour).ok());
    EXPECT_TRUE(depth == MkvTestDepth(4));
    EXPECT_TRUE(colour.empty());
}

TEST_F(MkvRecordings, DepthWhoseColourIsMissingIsNotUsed) {
    recipe.colour_count = 4;
    const auto recording = WriteAndOpen();
    ASSERT_TRUE(recording.ok()) << recording.message();
    EXPECT_EQ(recording.value()->info().pairs.size(), 4u);
    EXPECT_TRUE(Mentions(recording.value()->info().notes, "2 of 6 depth images"));
}

// Depth that was taken 30 ms after its colour is 10 ms before the next one.
TEST_F(MkvRecordings, DepthMayBeTakenLaterThanItsColour) {
    recipe.colour_late_ms = 10;
    auto recording = WriteAndOpen();
    ASSERT_TRUE(recording.ok()) << recording.message();
    ExpectPair(*recording.value(), 2, 2, 2);
    recipe.tags.push_back("K4A_DEPTH_DELAY_NS=30000000");
    recording = WriteAndOpen();
    ASSERT_TRUE(recording.ok()) << recording.message();
    ASSERT_EQ(recording.value()->info().pairs.size(), 5u);
    ExpectPair(*recording.value(), 2, 3, 2);
    EXPECT_NEAR(recording.value()->info().pairs[2].depth_stamp_s, 0.1 + 0.12, 1e-9);
    EXPECT_NEAR(recording.value()->info().pairs[2].colour_stamp_s, 0.1 + 0.09, 1e-9);
}

TEST_F(MkvRecordings, ColourMayBeTakenLaterThanItsStampSays) {
    recipe.colour_late_ms = 10;
    WriteMkv(folder, "a.mkv", recipe);
    const auto recording = OpenMkv(folder.Path("a.mkv"), 0.03);
    ASSERT_TRUE(recording.ok()) << recording.message();
    ASSERT_EQ(recording.value()->info().pairs.size(), 5u);
    ExpectPair(*recording.value(), 2, 3, 2);
}

TEST_F(MkvRecordings, WithoutACalibrationAUsualOneIsAssumed) {
    const std::string device = kK4aDevice;
    std::string implausible = device;
    implausible.replace(implausible.find("0.4927808940410614"), 18, "9.4927808940410614e2");
    for (const std::string& text : {std::string(), device.substr(0, 900), implausible}) {
        recipe.calibration = text;
        const auto recording = WriteAndOpen();
        ASSERT_TRUE(recording.ok()) << recording.message();
        const RecordingInfo& info = recording.value()->info();
        EXPECT_FALSE(info.camera_known);
        ASSERT_TRUE(Mentions(info.notes, "calibration.json"));
        EXPECT_EQ(text.empty(), Mentions(info.notes, "has no calibration.json"));
        EXPECT_NEAR(info.depth_camera.pinhole.fx, 252.3, 1);
        EXPECT_NEAR(info.colour_camera.pinhole.fx, 612, 5);
        ExpectPair(*recording.value(), 5, 5, 5);
    }
}

TEST_F(MkvRecordings, WhatIsNoRecordingIsRefusedByName) {
    ExpectRefused("no such file");
    folder.WriteText("a.mkv", "RIFF, or something else");
    ExpectRefused("no Matroska file");
    std::filesystem::remove(folder.Path("a.mkv"));
    std::filesystem::create_directory(folder.Path("a.mkv"));
    ExpectRefused("is a folder");
    std::filesystem::remove(folder.Path("a.mkv"));
    recipe.depth_count = 0;
    WriteMkv(folder, "a.mkv", recipe);
    ExpectRefused("plain video");
    recipe.depth_count = 3;
    recipe.depth_name = "IR";
    WriteMkv(folder, "a.mkv", recipe);
    ExpectRefused("PASSIVE_IR");
    recipe.depth_name = "DEPTH";
    recipe.colour_late_ms = 2000;
    WriteMkv(folder, "a.mkv", recipe);
    ExpectRefused("of the same time");
    recipe.colour_late_ms = 0;
    WriteMkv(folder, "a.mkv", recipe);
    std::string bytes = Bytes();
    folder.WriteText("a.mkv", bytes.replace(bytes.find("b16g"), 4, "Y800"));
    ExpectRefused("format Y800");
}

TEST_F(MkvRecordings, AFrameHasColourBesideItsDepth) {
    auto recording = WriteAndOpen();
    ASSERT_TRUE(recording.ok()) << recording.message();
    auto source = MakeRecordingSource("a.mkv", std::move(recording.value()), {});
    ASSERT_TRUE(source.ok()) << source.message();
    Frame frame;
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    const PinholeCamera& camera = source.value()->info().camera;
    const int x = static_cast<int>(std::lround(camera.cx)),
              y = static_cast<int>(std::lround(camera.cy));
    EXPECT_NEAR(frame.depth_m(x, y), 0.001f * static_cast<float>(MkvTestDepth(0)(x, y)), 0.004f);
    ASSERT_EQ(frame.colour.width(), kMkvDepthWidth);
    EXPECT_NEAR(frame.colour(x, y).g, 200, 8);  // the background of the colour image
}

}  // namespace
}  // namespace tessera
