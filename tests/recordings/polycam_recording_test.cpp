#include "recordings/polycam_recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <random>

#include "io/temporary_folder.h"
#include "recordings/phone_depth.h"

namespace tessera {
namespace {

// Names are microseconds.
std::uint64_t PolycamStampOf(int frame) {
    return 293'814'600'474 + static_cast<std::uint64_t>(frame) * 500'000;
}

Image<std::uint16_t> PolycamDepthOf(int frame) {
    Image<std::uint16_t> depth(32, 24);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x)
            depth(x, y) = static_cast<std::uint16_t>(500 + x * 90 + y + frame * 11);
    return depth;
}

std::string PolycamCamera(double fx = 70.5) {
    return fmt::format(
        R"({{"fx": {}, "fy": 71.5, "cx": 31.75, "cy": 23.25, "width": 64, "height": 48,
        "blur_score": 123.4, "manual_keyframe": false, "neighbors": [], "t_00": 1, "t_03": 0.5}})",
        fx);
}

class PolycamFolders : public ::testing::Test {
  protected:
    PolycamFolders() {
        for (const char* name : {"images", "depth", "confidence", "cameras"})
            std::filesystem::create_directories(folder.Path("keyframes/" + std::string(name)));
        for (int i = 0; i < 3; ++i) Write(std::to_string(PolycamStampOf(i)), i);
    }

    void Write(const std::string& name, int i) {
        cv::Mat image(48, 64, CV_8UC3), depth_values(24, 32, CV_16UC1), sure(24, 32, CV_8UC1);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x)
                image.at<cv::Vec3b>(y, x) = {static_cast<std::uint8_t>(3 * x),
                                             static_cast<std::uint8_t>(60 * i),
                                             static_cast<std::uint8_t>(5 * y)};
        const Image<std::uint16_t> raw = PolycamDepthOf(i);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x) {
                depth_values.at<std::uint16_t>(y, x) = raw(x, y);
                sure.at<std::uint8_t>(y, x) =
                    static_cast<std::uint8_t>(x < 5 ? 0 : (x < 20 ? 54 : 255));
            }
        ASSERT_TRUE(cv::imwrite(PathOf("images", name + ".jpg"), image));
        ASSERT_TRUE(cv::imwrite(PathOf("depth", name + ".png"), depth_values));
        ASSERT_TRUE(cv::imwrite(PathOf("confidence", name + ".png"), sure));
        folder.WriteText("keyframes/cameras/" + name + ".json", PolycamCamera());
    }
    std::string PathOf(const std::string& kind, const std::string& name) const {
        return folder.Path("keyframes/" + kind + "/" + name);
    }
    static std::string CameraName(int i) {
        return fmt::format("keyframes/cameras/{}.json", PolycamStampOf(i));
    }
    std::unique_ptr<Recording> Opened() {
        RecordingResult recording = OpenPolycamRecording(folder.path());
        EXPECT_TRUE(recording.ok()) << recording.message();
        return recording.ok() ? std::move(recording.value()) : nullptr;
    }
    void Refused(const std::string& what) {
        const RecordingResult recording = OpenPolycamRecording(folder.path());
        ASSERT_FALSE(recording.ok()) << what;
        EXPECT_TRUE(recording.message().starts_with(folder.path())) << recording.message();
        EXPECT_NE(recording.message().find(what), std::string::npos) << recording.message();
    }

    TemporaryFolder folder;
    Image<std::uint16_t> depth;
    ColourImage colour;
};

constexpr const char* kPolycamSlow =
    "keyframes are 0.50 s apart; where the camera moved fast between them, tracking may lose it";

TEST_F(PolycamFolders, ImagesCalibrationAndStampsAreExact) {
    EXPECT_TRUE(IsPolycamFolder(folder.path()));
    const auto recording = Opened();
    const RecordingInfo& info = recording->info();
    EXPECT_EQ(info.kind, "Polycam folder");
    const PinholeCamera camera{
        .width = 64, .height = 48, .fx = 70.5, .fy = 71.5, .cx = 31.75, .cy = 23.25};
    EXPECT_EQ(info.colour_camera.pinhole, camera);
    EXPECT_EQ(info.depth_camera.pinhole, ScaledTo(camera, 32, 24));
    EXPECT_EQ(info.depth_camera.depth_scale, 1000);
    EXPECT_EQ(info.notes, std::vector<std::string>{
                              "low-confidence depth (the lowest of three levels) is ignored"});
    EXPECT_EQ(info.warnings, std::vector<std::string>{kPolycamSlow});
    EXPECT_NEAR(info.fps, 2, 1e-9);
    ASSERT_EQ(info.pairs.size(), 3u);
    for (const int i : {2, 0, 1}) {
        const Status status = recording->Load(static_cast<std::size_t>(i), depth, colour);
        ASSERT_TRUE(status.ok()) << status.message();
        Image<std::uint16_t> expected = PolycamDepthOf(i);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 5; ++x) expected(x, y) = 0;
        EXPECT_EQ(depth, expected);
        const cv::Mat bgr =
            cv::imread(PathOf("images", std::to_string(PolycamStampOf(i)) + ".jpg"));
        ASSERT_EQ(colour.width(), bgr.cols);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x) {
                const auto& p = bgr.at<cv::Vec3b>(y, x);
                ASSERT_EQ(colour(x, y), (Rgb8{p[2], p[1], p[0]}));
            }
        EXPECT_DOUBLE_EQ(info.pairs[static_cast<std::size_t>(i)].depth_stamp_s,
                         293814.600474 + i * 0.5);
    }
}

TEST_F(PolycamFolders, FilesThatAreNoKeyframeAreLeftOut) {
    const std::string first = std::to_string(PolycamStampOf(0));
    for (const std::string& copy : {first + ".Clean.png", std::string("thumbnail.png")})
        std::filesystem::copy_file(PathOf("depth", first + ".png"), PathOf("depth", copy));
    std::filesystem::remove(PathOf("images", std::to_string(PolycamStampOf(1)) + ".jpg"));
    std::filesystem::remove(PathOf("confidence", std::to_string(PolycamStampOf(2)) + ".png"));
    const auto recording = Opened();
    ASSERT_EQ(recording->info().pairs.size(), 2u);
    EXPECT_EQ(recording->info().warnings.size(), 3u);
    ASSERT_TRUE(recording->Load(1, depth, colour).ok());
    EXPECT_EQ(depth, PolycamDepthOf(2));
}

TEST_F(PolycamFolders, CorrectedImagesAreTakenIfThereAreNoOthers) {
    std::filesystem::copy(folder.Path("keyframes/images"),
                          folder.Path("keyframes/corrected_images"));
    for (int i = 0; i < 3; ++i)
        folder.WriteText(fmt::format("keyframes/corrected_cameras/{}.json", PolycamStampOf(i)),
                         PolycamCamera(75));
    EXPECT_EQ(Opened()->info().colour_camera.pinhole.fx, 70.5);
    std::filesystem::remove_all(folder.Path("keyframes/images"));
    EXPECT_EQ(Opened()->info().colour_camera.pinhole.fx, 75);
    EXPECT_EQ(Opened()->info().warnings.size(), 2u);
    std::filesystem::remove_all(folder.Path("keyframes/corrected_cameras"));
    EXPECT_EQ(Opened()->info().colour_camera.pinhole.fx, 70.5);
    EXPECT_TRUE(IsPolycamFolder(folder.path()));
}

TEST_F(PolycamFolders, AnotherCameraIsAWarning) {
    folder.WriteText(CameraName(1), PolycamCamera(70.5 * 1.009));
    EXPECT_EQ(Opened()->info().warnings, std::vector<std::string>{kPolycamSlow});
    folder.WriteText(CameraName(2), PolycamCamera(70.5 * 1.011));
    EXPECT_EQ(Opened()->info().warnings,
              (std::vector<std::string>{"1 of 3 cameras differ by more than 1 % from the first "
                                        "one, which is used for all",
                                        kPolycamSlow}));
    folder.WriteText(CameraName(0), "{");
    const auto recording = Opened();
    EXPECT_DOUBLE_EQ(recording->info().colour_camera.pinhole.fx, 70.5 * 1.009);
    EXPECT_TRUE(recording->info().warnings[0].starts_with("1 of 3 cameras cannot be read"));
}

TEST_F(PolycamFolders, NumbersThatAreNoTimesAreEvenlySpaced) {
    for (const char* kind : {"images", "depth", "confidence", "cameras"}) {
        std::filesystem::remove_all(folder.Path("keyframes/" + std::string(kind)));
        std::filesystem::create_directories(folder.Path("keyframes/" + std::string(kind)));
    }
    for (int i = 0; i < 4; ++i) Write(fmt::format("{:05}", i + 8), i);
    const auto recording = Opened();
    EXPECT_EQ(recording->info().pairs[3].depth_stamp_s, 1.5);
    EXPECT_EQ(recording->info().notes.size(), 2u);
    ASSERT_TRUE(recording->Load(2, depth, colour).ok());
    EXPECT_EQ(depth(31, 23), PolycamDepthOf(2)(31, 23));  // 00010 is after 00009
}

TEST_F(PolycamFolders, WhatIsMissingOrDamagedIsNamed) {
    const std::string cameras[] = {
        "",
        "[]",
        "{\"fx\": 1}",
        R"({"fx": "70", "fy": 70, "cx": 32, "cy": 24, "width": 64, "height": 48})",
        R"({"fx": 1e999, "fy": 70, "cx": 32, "cy": 24, "width": 64, "height": 48})",
        R"({"fx": 70, "fy": 70, "cx": 32, "cy": 24, "width": 0, "height": 48})",
        R"({"fx": 70, "fy": 70, "cx": 320, "cy": 24, "width": 64, "height": 48})",
        std::string(100000, '['),
    };
    for (const std::string& camera : cameras) {
        for (int i = 0; i < 3; ++i) folder.WriteText(CameraName(i), camera);
        Refused(CameraName(0));
    }
    for (int i = 0; i < 3; ++i)
        folder.WriteText(CameraName(i), R"({"width": 1e300, "height": 48, "fx": 70, "fy": 70,
                                           "cx": 32, "cy": 24})");
    Refused("an image side of 1e+300 is not plausible");
    for (int i = 0; i < 3; ++i) folder.WriteText(CameraName(i), PolycamCamera());
    for (int i = 0; i < 3; ++i)
        folder.WriteDepth(fmt::format("keyframes/depth/{}.png", PolycamStampOf(i)), 24, 32, 1);
    Refused("another shape");
    std::filesystem::remove_all(folder.Path("keyframes/images"));
    Refused("keyframes: has no keyframe with depth, image and camera");
    std::filesystem::remove_all(folder.Path("keyframes/depth"));
    EXPECT_FALSE(IsPolycamFolder(folder.path()));
    Refused("keyframes: has no keyframe");
}

TEST_F(PolycamFolders, ADamagedFrameIsRefusedAlone) {
    const std::string first = fmt::format("keyframes/depth/{}.png", PolycamStampOf(0));
    const std::string second = fmt::format("keyframes/images/{}.jpg", PolycamStampOf(1));
    folder.WriteText(first, ReadText(folder.Path(first)).substr(0, 90));
    folder.WriteText(second, ReadText(folder.Path(second)).substr(0, 300));
    const auto recording = Opened();
    for (const std::size_t i : {0u, 1u}) {
        const std::string message = recording->Load(i, depth, colour).message();
        EXPECT_TRUE(message.starts_with((i == 0 ? first : second) + ": is ")) << message;
        EXPECT_NE(message.find("truncated or damaged"), std::string::npos) << message;
    }
    EXPECT_TRUE(recording->Load(2, depth, colour).ok());
}

TEST_F(PolycamFolders, MutatedCamerasNeverCrash) {
    std::mt19937 random(4);
    const std::string camera = PolycamCamera();
    for (int run = 0; run < 300; ++run) {
        std::string text = camera;
        for (std::size_t n = 1 + random() % 3; n > 0; --n)
            text[random() % text.size()] =
                static_cast<char>(random() % 2 == 0 ? '0' + random() % 10 : random() % 256);
        for (int i = 0; i < 3; ++i) folder.WriteText(CameraName(i), text);
        const RecordingResult recording = OpenPolycamRecording(folder.path());
        if (recording.ok()) {
            EXPECT_TRUE(recording.value()->Load(0, depth, colour).ok());
        }
    }
}

}  // namespace
}  // namespace tessera
