#include "io/frame_recorder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdlib>

#include "io/folder_source.h"
#include "io/temporary_folder.h"

namespace tessera {
namespace {

SourceInfo SomeSource() {
    SourceInfo info;
    info.name = "camera";
    info.camera = {64, 48, 61.7, 60.3, 31.1, 24.2};
    info.fps = 15;
    info.depth_units_per_m = 1000;
    return info;
}

// Depths are whole units, and every stored value occurs.
Frame SomeFrame(int index, bool with_truth = false) {
    Frame frame;
    frame.index = index;
    frame.stamp_s = 12.345678 + index / 15.0;
    frame.colour_stamp_s = frame.stamp_s + 0.004;
    frame.colour = ColourImage(64, 48, {static_cast<std::uint8_t>(40 * index), 100, 50});
    frame.depth_m = DepthImage(64, 48);
    for (std::size_t i = 0; i < frame.depth_m.size(); ++i)
        frame.depth_m.data()[i] =
            static_cast<float>((i * 64 + static_cast<std::size_t>(index)) % 65536) / 1000.0f;
    if (with_truth) {
        frame.T_world_camera = Eigen::Isometry3d::Identity();
        frame.T_world_camera->translation().x() = 0.1 * index;
    }
    return frame;
}

std::unique_ptr<FrameRecorder> Create(const std::string& folder, const RecordConfig& config = {}) {
    auto recorder = FrameRecorder::Create(folder, SomeSource(), config);
    EXPECT_TRUE(recorder.ok()) << recorder.message();
    return recorder.ok() ? std::move(recorder.value()) : nullptr;
}

std::vector<Frame> ReadBack(const std::string& folder) {
    auto source = OpenFolderSource(folder, {});
    EXPECT_TRUE(source.ok()) << source.message();
    std::vector<Frame> frames;
    if (!source.ok()) return frames;
    EXPECT_EQ(source.value()->info().camera, SomeSource().camera);
    EXPECT_EQ(source.value()->info().fps, 15);
    EXPECT_EQ(source.value()->info().depth_units_per_m, 1000);
    for (Frame frame; source.value()->Read(frame).status == ReadStatus::kOk;)
        frames.push_back(frame);
    return frames;
}

TEST(FrameRecorder, WhatIsReadBackIsWhatWasGiven) {
    for (const auto colour : {RecordConfig::Colour::kPng, RecordConfig::Colour::kJpeg}) {
        TemporaryFolder folder;
        const std::string path = folder.Path("scan");
        const auto recorder = Create(path, {colour});
        ASSERT_NE(recorder, nullptr);
        for (int i = 0; i < 4; ++i) ASSERT_TRUE(recorder->Add(SomeFrame(i, true)).ok());
        ASSERT_TRUE(recorder->Finish().ok());
        const std::vector<Frame> frames = ReadBack(path);
        ASSERT_EQ(frames.size(), 4u);
        for (int i = 0; i < 4; ++i) {
            const Frame& read = frames[static_cast<std::size_t>(i)];
            const Frame given = SomeFrame(i, true);
            EXPECT_EQ(read.depth_m, given.depth_m);
            EXPECT_NEAR(read.stamp_s, given.stamp_s, 6e-7);  // written with microsecond resolution
            EXPECT_NEAR(read.colour_stamp_s, given.colour_stamp_s, 6e-7);
            ASSERT_TRUE(read.T_world_camera);
            EXPECT_TRUE(read.T_world_camera->isApprox(*given.T_world_camera, 1e-9));
            if (colour == RecordConfig::Colour::kPng) {
                EXPECT_EQ(read.colour, given.colour);
            }
            EXPECT_LE(std::abs(read.colour(9, 9).r - given.colour(9, 9).r), 3);
        }
    }
}

TEST(FrameRecorder, AtAnyMomentTheFolderIsReadable) {
    TemporaryFolder folder;
    const auto recorder = Create(folder.Path("scan"));
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(recorder->Add(SomeFrame(i)).ok());
        // The recorder has not been closed.
        EXPECT_EQ(ReadBack(folder.Path("scan")).size(), static_cast<std::size_t>(i + 1));
        EXPECT_EQ(recorder->frames(), i + 1);
    }
}

TEST(FrameRecorder, NeverOverwritesARecording) {
    TemporaryFolder folder;
    ASSERT_NE(Create(folder.Path("scan")), nullptr);
    EXPECT_EQ(FrameRecorder::Create(folder.Path("scan"), SomeSource()).message(),
              folder.Path("scan") + ": already contains a recording; give a new folder name");
    folder.WriteText("file", "x");
    EXPECT_FALSE(FrameRecorder::Create(folder.Path("file"), SomeSource()).ok());
}

TEST(FrameRecorder, ASourceWithoutColourIsRefusedBeforeAnythingIsWritten) {
    TemporaryFolder folder;
    SourceInfo source = SomeSource();
    source.has_colour = false;
    EXPECT_EQ(FrameRecorder::Create(folder.Path("scan"), source).message(),
              "camera: cannot be recorded: it has no colour, which a recorded folder needs");
    EXPECT_FALSE(std::filesystem::exists(folder.Path("scan")));
}

TEST(FrameRecorder, FramesThatDoNotFitAreRefusedByNameAndTheOthersRecorded) {
    TemporaryFolder folder;
    Frame small = SomeFrame(1), grey = SomeFrame(1), late = SomeFrame(0);
    small.depth_m = DepthImage(32, 24);
    grey.colour = ColourImage();
    for (const auto& [frame, why] :
         {std::pair{&small, "64 x 48 pixels"}, {&grey, "no colour"}, {&late, "its time stamp"}}) {
        const auto recorder = Create(folder.Path(why));
        ASSERT_TRUE(recorder->Add(SomeFrame(0)).ok());
        const Status status = recorder->Add(*frame);
        EXPECT_NE(status.message().find(why), std::string::npos) << status.message();
        EXPECT_EQ(recorder->WhyNot(*frame), status.message());
        EXPECT_EQ(recorder->WhyNot(SomeFrame(2)), "");
        EXPECT_TRUE(recorder->Add(SomeFrame(2)).ok());
        EXPECT_TRUE(recorder->Finish().ok());
        EXPECT_EQ(ReadBack(folder.Path(why)).size(), 2u);
    }
}

// A file size limit simulates a full disk. The first limit fails within an image, the second within
// a list.
TEST(FrameRecorder, AFullDiskLosesNothingThatWasSafe) {
    signal(SIGXFSZ, SIG_IGN);
    for (const rlim_t limit : {rlim_t{4500}, rlim_t{150}}) {
        TemporaryFolder folder;
        const std::string path = folder.Path("scan");
        RecordConfig config;
        config.colour = RecordConfig::Colour::kPng;
        const auto recorder = Create(path, config);
        Frame frame = SomeFrame(0);
        frame.depth_m = DepthImage(64, 48, 1.0f);  // small files
        ASSERT_TRUE(recorder->Add(frame).ok());
        ASSERT_TRUE(recorder
                        ->Add([&] {
                            frame.stamp_s += 0.1;
                            frame.colour_stamp_s += 0.1;
                            return frame;
                        }())
                        .ok());
        const std::string list_before = ReadText(path + "/depth.txt");
        rlimit before{};
        getrlimit(RLIMIT_FSIZE, &before);
        const rlimit lowered{limit, before.rlim_max};
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &lowered), 0);
        Status status;
        for (int i = 2; i < 200 && status.ok(); ++i) {
            // Either large depth files, or lists that grow past the limit.
            Frame next = limit > 1000 ? SomeFrame(i) : frame;
            next.stamp_s = 20 + i;
            next.colour_stamp_s = 20 + i;
            status = recorder->Add(next);
        }
        setrlimit(RLIMIT_FSIZE, &before);
        ASSERT_FALSE(status.ok());
        EXPECT_EQ(status.message().find(path), 0u) << status.message();
        EXPECT_NE(status.message().find("cannot be written"), std::string::npos)
            << status.message();
        const auto safe = static_cast<std::size_t>(recorder->frames());
        EXPECT_NE(status.message().find(fmt::format("; {} frames are safe in {}", safe, path)),
                  std::string::npos);
        EXPECT_GE(safe, 2u);
        EXPECT_EQ(ReadBack(path).size(), safe);
        EXPECT_TRUE(ReadText(path + "/depth.txt").starts_with(list_before));
        EXPECT_TRUE(ReadText(path + "/depth.txt").ends_with("\n"));
    }
}

}  // namespace
}  // namespace tessera
