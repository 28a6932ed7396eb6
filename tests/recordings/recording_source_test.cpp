#include "recordings/recording_source.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/temporary_folder.h"

namespace tessera {
namespace {

constexpr PinholeCamera kSmallCamera{32, 24, 30, 30, 15.5, 11.5};

// Ten pairs; pair 3 is damaged, pair 4 has another size.
class MadeUpRecording : public Recording {
  public:
    MadeUpRecording() {
        info_.kind = "made up";
        info_.depth_camera.pinhole = info_.colour_camera.pinhole = kSmallCamera;
        info_.depth_camera.depth_scale = 1000;
        for (int i = 0; i < 10; ++i) info_.pairs.push_back({0.1 * i, 0.1 * i + 0.01});
    }
    const RecordingInfo& info() const override { return info_; }
    Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) override {
        if (index == 3) return Status::Error("a damaged message");
        depth.Resize(index == 4 ? 16 : 32, 24);
        std::fill_n(depth.data(), depth.size(), static_cast<std::uint16_t>(1000 + index));
        colour.Resize(info_.colour_camera.pinhole.width, info_.colour_camera.pinhole.height);
        std::fill_n(colour.data(), colour.size(), Rgb8{static_cast<std::uint8_t>(index), 0, 0});
        return {};
    }
    RecordingInfo info_;
};

std::unique_ptr<FrameSource> MadeUpSource(std::unique_ptr<MadeUpRecording> recording,
                                          const FolderSourceConfig& config = {}) {
    auto source = MakeRecordingSource("/made/up", std::move(recording), config);
    EXPECT_TRUE(source.ok()) << source.message();
    return std::move(source.value());
}

TEST(RecordingSource, DeliversFramesInMetresAndSkipsBadOnes) {
    const auto source = MadeUpSource(std::make_unique<MadeUpRecording>());
    EXPECT_EQ(source->info().frame_count, 10);
    EXPECT_EQ(source->info().kind, "made up");
    Frame frame;
    for (int i = 0; i < 10; ++i) {
        const ReadResult read = source->Read(frame);
        if (i == 3) {
            EXPECT_EQ(read.status, ReadStatus::kSkip);
            EXPECT_EQ(read.message, "/made/up: frame 3: a damaged message");
            continue;
        }
        if (i == 4) {
            EXPECT_EQ(read.message,
                      "/made/up: frame 4: depth has 16 x 24 pixels, but its camera has 32 x 24");
            continue;
        }
        ASSERT_EQ(read.status, ReadStatus::kOk) << read.message;
        EXPECT_EQ(frame.index, i);
        EXPECT_DOUBLE_EQ(frame.stamp_s, 0.1 * i);
        EXPECT_DOUBLE_EQ(frame.colour_stamp_s, 0.1 * i + 0.01);
        EXPECT_FLOAT_EQ(frame.depth_m(5, 5), 1 + 0.001f * static_cast<float>(i));
        EXPECT_EQ(frame.colour(5, 5).r, i);
    }
    EXPECT_EQ(source->Read(frame).status, ReadStatus::kEnd);
    ASSERT_TRUE(source->Seek(7));
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 7);
    EXPECT_FALSE(source->Seek(11));
}

// As `finish` reads what a run has read: with the intrinsics of depth that the run used.
TEST(RecordingSource, ColourWithALensOfItsOwnKeepsIt) {
    class Ramp : public MadeUpRecording {
        Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) override {
            const Status status = MadeUpRecording::Load(index, depth, colour);
            for (int y = 0; y < colour.height(); ++y)
                for (int x = 0; x < colour.width(); ++x)
                    colour(x, y).r = static_cast<std::uint8_t>(8 * x);
            return status;
        }
    };
    const auto first_red = [](double colour_fx, bool camera_given) {
        auto recording = std::make_unique<Ramp>();
        recording->info_.colour_camera.pinhole.fx = colour_fx;
        FolderSourceConfig config;
        if (camera_given) config.camera = kSmallCamera;
        const auto source = MadeUpSource(std::move(recording), config);
        EXPECT_EQ(source->info().one_camera, colour_fx == 30);
        Frame frame;
        EXPECT_EQ(source->Read(frame).status, ReadStatus::kOk);
        return int{frame.colour(10, 12).r};
    };
    EXPECT_EQ(first_red(30, false), 80);
    EXPECT_EQ(first_red(30, true), 80);
    EXPECT_NEAR(first_red(45, false), 8 * (15.5 - 1.5 * 5.5), 2);
    EXPECT_EQ(first_red(45, true), first_red(45, false));
}

TEST(RecordingSource, SaysWhetherThereIsColour) {
    for (const bool has_colour : {false, true}) {
        auto recording = std::make_unique<MadeUpRecording>();
        recording->info_.has_colour = has_colour;
        EXPECT_EQ(MadeUpSource(std::move(recording))->info().has_colour, has_colour);
    }
}

TEST(RecordingSource, CorrectsTheTimeStamps) {
    const auto source =
        MadeUpSource(std::make_unique<MadeUpRecording>(), {.colour_delay_s = -0.006});
    Frame frame;
    ASSERT_TRUE(source->Seek(2));
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.correction.colour_s, -0.006);
    EXPECT_NEAR(frame.stamp_s, 0.2, 1e-12);
    EXPECT_NEAR(frame.colour_stamp_s, 0.204, 1e-12);
    ASSERT_GT(source->Stamps_s().size(), 2u);
    EXPECT_EQ(source->Stamps_s()[2], frame.stamp_s);
}

TEST(RecordingSource, ColourOfAnotherSizeIsBroughtIntoTheDepthView) {
    auto recording = std::make_unique<MadeUpRecording>();
    recording->info_.colour_camera.pinhole = {64, 48, 60, 60, 31.5, 23.5};
    const auto source = MadeUpSource(std::move(recording));
    Frame frame;
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.colour.width(), 32);
    EXPECT_EQ(frame.colour.height(), 24);
}

TEST(RecordingSource, TheConfigurationReplacesTheCameraAndTheUnit) {
    FolderSourceConfig config;
    config.camera = PinholeCamera{640, 480, 40, 41, 16, 12};
    config.depth_scale = 500;
    auto recording = std::make_unique<MadeUpRecording>();
    recording->info_.colour_camera.pinhole = {64, 48, 60, 60, 31.5, 23.5};
    const auto source = MadeUpSource(std::move(recording), config);
    EXPECT_EQ(source->info().camera, (PinholeCamera{32, 24, 40, 41, 16, 12}));
    Frame frame;
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_FLOAT_EQ(frame.depth_m(5, 5), 2);
}

TEST(RecordingSource, WhereTheFormatHasMetresNobodyElseGivesTheUnit) {
    TemporaryFolder folder;
    const std::string file = folder.Path("camera.yaml");
    std::ofstream(file)
        << "width: 32\nheight: 24\nfx: 41\nfy: 42\ncx: 16\ncy: 12\ndepth_scale: 500\n";
    for (const bool has_file : {false, true}) {
        auto recording = std::make_unique<MadeUpRecording>();
        recording->info_.depth_in_m = true;
        recording->info_.camera_known = !has_file;
        FolderSourceConfig config;
        if (!has_file) config.depth_scale = 500;
        const auto source = MakeRecordingSource("/made/up", std::move(recording), config, file);
        ASSERT_TRUE(source.ok()) << source.message();
        Frame frame;
        ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
        EXPECT_FLOAT_EQ(frame.depth_m(5, 5), 1);
        EXPECT_EQ(source.value()->info().notes.back(),
                  std::string("depth is recorded in metres: ") +
                      (has_file ? "its depth_scale" : "source.depth_scale") + " is not applied");
    }
}

TEST(RecordingSource, ACameraFileCountsWhereTheRecordingHasNoCamera) {
    TemporaryFolder folder;
    const std::string file = folder.Path("camera.yaml");
    const std::string values = "height: 24\nfx: 41\nfy: 42\ncx: 16\ncy: 12\ndepth_scale: 500\n";
    std::ofstream(file) << "width: 32\n" << values;
    const auto open = [&](bool known) {
        auto recording = std::make_unique<MadeUpRecording>();
        recording->info_.camera_known = known;
        recording->info_.notes = {"/depth: no camera_info: assuming"};
        recording->info_.colour_camera.pinhole = {64, 48, 60, 60, 31.5, 23.5};
        return MakeRecordingSource("/made/up", std::move(recording), {}, file);
    };
    auto source = open(false);
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_EQ(source.value()->info().camera, (PinholeCamera{32, 24, 41, 42, 16, 12}));
    EXPECT_TRUE(source.value()->info().camera_known);
    EXPECT_EQ(source.value()->info().camera_from, "camera.yaml");
    EXPECT_EQ(source.value()->info().notes,
              std::vector<std::string>{"the camera is that of " + file});
    Frame frame;
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_FLOAT_EQ(frame.depth_m(5, 5), 2);
    EXPECT_EQ(open(true).value()->info().camera, kSmallCamera);
    EXPECT_EQ(open(true).value()->info().camera_from, "the recording");
    std::ofstream(file) << "width: 33\n" << values;
    EXPECT_EQ(open(false).message(), file + ": is for images of 33 x 24, but depth has 32 x 24");
}

TEST(RecordingSource, ARecordingWithoutGoodPairsIsRefused) {
    auto recording = std::make_unique<MadeUpRecording>();
    recording->info_.depth_camera.pinhole = {30, 24, 30, 30, 15.5, 11.5};
    const auto source = MakeRecordingSource("/made/up", std::move(recording), {});
    EXPECT_EQ(source.message(), "/made/up: depth has 32 x 24 pixels, but its camera has 30 x 24");
    recording = std::make_unique<MadeUpRecording>();
    recording->info_.pairs.clear();
    EXPECT_EQ(MakeRecordingSource("/made/up", std::move(recording), {}).message(),
              "/made/up: no pair of depth and colour images");
    recording = std::make_unique<MadeUpRecording>();
    recording->info_.depth_camera.pinhole.fx = 0;
    EXPECT_EQ(MakeRecordingSource("/made/up", std::move(recording), {}).message(),
              "/made/up: its calibration: fx: 0 is not plausible");
}

}  // namespace
}  // namespace tessera
