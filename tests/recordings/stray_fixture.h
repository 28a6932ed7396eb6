// A small Stray Scanner folder for a test, and what must be read from it.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "io/temporary_folder.h"
#include "recordings/stray_recording.h"

namespace tessera {

inline constexpr int kStrayWidth = 64, kStrayHeight = 48;

inline Image<std::uint16_t> StrayDepthOf(int frame) {
    Image<std::uint16_t> depth(32, 24);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x)
            depth(x, y) = static_cast<std::uint16_t>(500 + x * 100 + y + frame * 7);
    return depth;
}

// Low on the left, high on the right.
inline Image<std::uint8_t> StrayConfidence() {
    Image<std::uint8_t> sure(32, 24);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) sure(x, y) = static_cast<std::uint8_t>(x / 11);
    return sure;
}

// Six blocks are the bits of the frame's number, so that it can be read after lossy compression;
// the rest differs in each pixel and channel.
inline ColourImage StrayColourOf(int frame) {
    ColourImage colour(kStrayWidth, kStrayHeight);
    for (int y = 0; y < kStrayHeight; ++y)
        for (int x = 0; x < kStrayWidth; ++x) {
            const auto bit = static_cast<std::uint8_t>((frame >> (x / 16 + 4 * (y / 16))) % 2);
            colour(x, y) = {static_cast<std::uint8_t>(40 + 150 * bit + x % 16),
                            static_cast<std::uint8_t>(50 + 150 * bit + y % 16),
                            static_cast<std::uint8_t>(30 + 150 * bit + (x + y) % 16)};
        }
    return colour;
}

class StrayFixture : public ::testing::Test {
  protected:
    // False if OpenCV cannot write the compression.
    bool WriteVideo(const char* codec, int count) {
        cv::VideoWriter writer;
        const int code = cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]);
        if (!writer.open(folder.Path("rgb.mp4"), cv::CAP_FFMPEG, code, 60,
                         {kStrayWidth, kStrayHeight}))
            return false;
        for (int i = 0; i < count; ++i) {
            ColourImage image = StrayColourOf(i);
            cv::Mat bgr, rgb(kStrayHeight, kStrayWidth, CV_8UC3, image.data());
            cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
            writer.write(bgr);
        }
        return true;
    }
    void WriteRest(int count) {
        folder.WriteText("camera_matrix.csv", "80.5, 0.0, 31.25\n0.0, 81.5, 23.75\n0.0, 0.0, 1.0");
        std::string odometry = "timestamp, frame, x, y, z, qx, qy, qz, qw\n";
        for (int i = 0; i < count; ++i) {
            const std::string name = fmt::format("{:06}", i);
            std::filesystem::create_directories(folder.Path("depth"));
            std::filesystem::create_directories(folder.Path("confidence"));
            ASSERT_TRUE(
                WriteDepthImage(folder.Path("depth/" + name + ".png"), StrayDepthOf(i)).ok());
            ASSERT_TRUE(
                WriteGreyImage(folder.Path("confidence/" + name + ".png"), StrayConfidence()).ok());
            odometry += fmt::format("{}, {}, 0.1, 0.2, 0.3, 0, 0, 0, 1\n", 5000.5 + i * 0.02, name);
        }
        folder.WriteText("odometry.csv", odometry);
    }
    std::unique_ptr<Recording> Opened() {
        RecordingResult recording = OpenStrayRecording(folder.path());
        EXPECT_TRUE(recording.ok()) << recording.message();
        return recording.ok() ? std::move(recording.value()) : nullptr;
    }
    void Refused(const std::string& what) {
        const RecordingResult recording = OpenStrayRecording(folder.path());
        ASSERT_FALSE(recording.ok()) << what;
        EXPECT_TRUE(recording.message().starts_with(folder.path())) << recording.message();
        EXPECT_NE(recording.message().find(what), std::string::npos) << recording.message();
    }

    TemporaryFolder folder;
    Image<std::uint16_t> depth;
    ColourImage colour;
};

}  // namespace tessera
