#include "recordings/stray_recording.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "recordings/phone_depth.h"
#include "recordings/stray_fixture.h"

namespace tessera {
namespace {

using StrayFolders = StrayFixture;

int StrayNumberIn(const ColourImage& colour) {
    int number = 0;
    for (int block = 0; block < 12; ++block)
        if (colour(block % 4 * 16 + 8, block / 4 * 16 + 8).g > 130) number |= 1 << block;
    return number;
}

#define TESSERA_STRAY_VIDEO(codec, count) \
    if (!WriteVideo(codec, count)) GTEST_SKIP() << "OpenCV's FFmpeg cannot write " codec

TEST_F(StrayFolders, ImagesCalibrationAndStampsAreExact) {
    TESSERA_STRAY_VIDEO("MPNG", 4);  // without loss
    WriteRest(4);
    EXPECT_TRUE(IsStrayFolder(folder.path()));
    const auto recording = Opened();
    const RecordingInfo& info = recording->info();
    EXPECT_EQ(info.kind, "Stray Scanner folder");
    const PinholeCamera camera{
        .width = 64, .height = 48, .fx = 80.5, .fy = 81.5, .cx = 31.25, .cy = 23.75};
    EXPECT_EQ(info.colour_camera.pinhole, camera);
    EXPECT_EQ(info.depth_camera.pinhole, ScaledTo(camera, 32, 24));
    EXPECT_EQ(info.depth_camera.depth_scale, 1000);
    EXPECT_EQ(info.notes, std::vector<std::string>{
                              "low-confidence depth (the lowest of three levels) is ignored"});
    EXPECT_EQ(info.warnings, std::vector<std::string>{});
    ASSERT_EQ(info.pairs.size(), 4u);
    EXPECT_NEAR(info.fps, 50, 1e-6);
    for (const int i : {0, 1, 2, 3, 3, 1}) {
        const Status status = recording->Load(static_cast<std::size_t>(i), depth, colour);
        ASSERT_TRUE(status.ok()) << status.message();
        EXPECT_EQ(colour, StrayColourOf(i)) << i;
        Image<std::uint16_t> expected = StrayDepthOf(i);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 11; ++x) expected(x, y) = 0;
        EXPECT_EQ(depth, expected);
        EXPECT_DOUBLE_EQ(info.pairs[static_cast<std::size_t>(i)].depth_stamp_s, 5000.5 + i * 0.02);
        EXPECT_DOUBLE_EQ(info.pairs[static_cast<std::size_t>(i)].colour_stamp_s, 5000.5 + i * 0.02);
    }
}

// avc1 has frames that are stored in another order than they are shown.
TEST_F(StrayFolders, FrameNIsFrameNAlsoAfterJumps) {
    constexpr int kCount = 50;
    WriteRest(kCount);
    int written = 0;
    for (const char* codec : {"mp4v", "avc1"}) {
        if (!WriteVideo(codec, kCount)) continue;
        ++written;
        const auto recording = Opened();
        std::vector<std::size_t> order(kCount);
        for (std::size_t i = 0; i < kCount; ++i) order[i] = i;
        for (const std::size_t i : {0u, 49u, 48u, 13u, 13u, 14u, 30u, 2u, 49u, 0u})
            order.push_back(i);
        for (const std::size_t i : order) {
            ASSERT_TRUE(recording->Load(i, depth, colour).ok());
            EXPECT_EQ(StrayNumberIn(colour), i) << codec;
            const ColourImage expected = StrayColourOf(static_cast<int>(i));
            double difference = 0;
            for (std::size_t p = 0; p < colour.size(); ++p)
                difference += std::abs(colour.data()[p].r - expected.data()[p].r) +
                              std::abs(colour.data()[p].b - expected.data()[p].b);
            EXPECT_LT(difference / 2 / static_cast<double>(colour.size()), 12) << codec << i;
        }
    }
    if (written == 0) GTEST_SKIP() << "OpenCV's FFmpeg cannot write mp4v or avc1";
}

TEST_F(StrayFolders, ANumberInANameIsTheFrameOfTheVideo) {
    TESSERA_STRAY_VIDEO("MPNG", 5);
    WriteRest(5);
    // The phone had no depth yet when it started.
    for (const char* name : {"depth/000000.png", "depth/000001.png", "confidence/000003.png"})
        std::filesystem::remove(folder.Path(name));
    const auto recording = Opened();
    ASSERT_EQ(recording->info().pairs.size(), 3u);
    EXPECT_EQ(recording->info().warnings,
              std::vector<std::string>{
                  "1 of 3 depth images have no confidence image; all of their depth is used"});
    EXPECT_DOUBLE_EQ(recording->info().pairs[0].depth_stamp_s, 5000.54);
    ASSERT_TRUE(recording->Load(1, depth, colour).ok());
    EXPECT_EQ(depth, StrayDepthOf(3));
    EXPECT_EQ(colour, StrayColourOf(3));
}

// Phones store the video as the sensor sees it and say how to turn it. Depth is not turned.
TEST_F(StrayFolders, TheVideosOrientationIsIgnored) {
    TESSERA_STRAY_VIDEO("MPNG", 2);
    WriteRest(2);
    std::string video = ReadText(folder.Path("rgb.mp4"));
    const std::size_t track = video.find("tkhd");
    ASSERT_NE(track, std::string::npos);
    // A quarter turn: the matrix is 40 bytes after the version, numbers of 16.16 bits.
    const std::string turned("\0\0\0\0\0\1\0\0\0\0\0\0\xff\xff\0\0", 16);
    video.replace(track + 4 + 40, 16, turned);
    folder.WriteText("rgb.mp4", video);
    cv::VideoCapture capture(folder.Path("rgb.mp4"), cv::CAP_FFMPEG);
    ASSERT_NE(capture.get(cv::CAP_PROP_ORIENTATION_META), 0) << "the test turns nothing";
    const auto recording = Opened();
    ASSERT_NE(recording, nullptr);
    for (const std::size_t i : {1u, 0u}) {  // also after starting again
        ASSERT_TRUE(recording->Load(i, depth, colour).ok());
        EXPECT_EQ(colour, StrayColourOf(static_cast<int>(i)));
    }
}

TEST_F(StrayFolders, WithoutGoodStampsTheVideosRateIsTaken) {
    TESSERA_STRAY_VIDEO("MPNG", 3);
    WriteRest(3);
    const std::string header = "timestamp, frame, x\n";
    for (const std::string& odometry :
         {std::string(), std::string("x, y, z\n1, 2, 3\n"), header + "5, 0, 1\n6, 1, 1\n",
          header + "5, 0, 1\n6, 1, 1\n6, 2, 1\n", header + "5, 0, 1\nnan, 1, 1\n7, 2, 1\n",
          header + std::string(100000, ',') + "\n\n,\n1\n1,\n"}) {
        folder.WriteText("odometry.csv", odometry);
        const auto recording = Opened();
        EXPECT_DOUBLE_EQ(recording->info().pairs[2].depth_stamp_s, 2 / 60.0) << odometry;
        EXPECT_DOUBLE_EQ(recording->info().fps, 60);
        ASSERT_EQ(recording->info().notes.size(), 2u);
        EXPECT_EQ(recording->info().notes[1].find("odometry.csv has no increasing"), 0u);
    }
    std::filesystem::remove(folder.Path("odometry.csv"));
    EXPECT_EQ(Opened()->info().notes[1],
              "odometry.csv is missing; 60 frames per second are assumed");
    // Other columns, more lines, and lines that end as on Windows.
    folder.WriteText("odometry.csv", "frame,fx,timestamp\r\n000002,1,9\r\n0,1,7\r\n1,1,8\r\n3,1,0");
    EXPECT_EQ(Opened()->info().pairs[2].depth_stamp_s, 9);
}

TEST_F(StrayFolders, WhatIsMissingOrDamagedIsNamed) {
    TESSERA_STRAY_VIDEO("MPNG", 2);
    WriteRest(2);
    const std::string video = ReadText(folder.Path("rgb.mp4"));
    for (const std::string& matrix :
         {std::string(), std::string("1, 2\n3, 4\n"), std::string("a, b, c\nd, e, f\ng, h, i\n"),
          std::string("80, 0, 32\n0, 80, 24\n0, 0, 2\n"),
          std::string("80, 0, 32\n0, 80, 24\n0, 0, nan\n"), std::string(5000, '\n')}) {
        folder.WriteText("camera_matrix.csv", matrix);
        Refused("camera_matrix.csv: is no camera matrix");
    }
    folder.WriteText("camera_matrix.csv", "80, 0, 320\n0, 80, 24\n0, 0, 1\n");
    Refused("camera_matrix.csv: cx: 320 is not plausible");
    WriteRest(2);
    folder.WriteText("rgb.mp4", "#EXTM3U\nhttp://example.com/a.ts\n");
    Refused("rgb.mp4: is no MP4 video");
    folder.WriteText("rgb.mp4", video.substr(0, video.size() / 2));
    Refused("rgb.mp4: is no video, is damaged");
    std::filesystem::remove(folder.Path("rgb.mp4"));
    Refused("rgb.mp4: no such file");
    EXPECT_FALSE(IsStrayFolder(folder.path()));
    folder.WriteText("rgb.mp4", video);
    folder.WriteDepth("depth/000000.png", 24, 32, 1000);
    Refused("another shape");
    std::filesystem::remove_all(folder.Path("depth"));
    Refused("depth: has no depth images");
    EXPECT_FALSE(IsStrayFolder(folder.path()));
}

TEST_F(StrayFolders, AFrameThatCannotBeReadIsRefusedAlone) {
    TESSERA_STRAY_VIDEO("MPNG", 3);
    WriteRest(5);
    folder.WriteText("depth/000001.png", "no image");
    const auto recording = Opened();
    EXPECT_EQ(recording->info().warnings.size(), 1u);  // the video is shorter
    const auto message = [&](std::size_t i) { return recording->Load(i, depth, colour).message(); };
    EXPECT_EQ(message(0), "");
    EXPECT_TRUE(message(1).starts_with("depth/000001.png: is not an image")) << message(1);
    EXPECT_EQ(message(2), "");
    EXPECT_EQ(message(4), "the video ends at frame 3, or is damaged there");
    EXPECT_EQ(message(3), "the video ends at frame 3, or is damaged there");
    EXPECT_EQ(message(2), "");
    EXPECT_EQ(colour, StrayColourOf(2));
}

TEST_F(StrayFolders, MutatedVideosNeverCrash) {
    TESSERA_STRAY_VIDEO("mp4v", 8);
    WriteRest(8);
    const std::string video = ReadText(folder.Path("rgb.mp4"));
    std::mt19937 random(3);
    for (int run = 0; run < 40; ++run) {
        std::string bytes = video;
        for (int n = 0; n < 6; ++n)
            bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
        folder.WriteText("rgb.mp4", bytes);
        const RecordingResult recording = OpenStrayRecording(folder.path());
        if (!recording.ok()) continue;
        for (const std::size_t i : {0u, 7u, 3u})
            if (recording.value()->Load(i, depth, colour).ok()) {
                EXPECT_EQ(colour.width(), recording.value()->info().colour_camera.pinhole.width);
            }
    }
}

}  // namespace
}  // namespace tessera
