#include "io/folder_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/temporary_folder.h"

namespace tessera {
namespace {

// Writes `count` frames of 32 x 24. Frame i has depth i + 1 metres and red value 10 i.
void WriteSequence(const TemporaryFolder& folder, int count) {
    std::string depth_list, colour_list;
    for (int i = 0; i < count; ++i) {
        const std::string name = std::to_string(i) + ".png";
        folder.WriteDepth("depth/" + name, 32, 24, static_cast<std::uint16_t>(1000 * (i + 1)));
        folder.WriteColour("rgb/" + name, 32, 24, {static_cast<std::uint8_t>(10 * i), 20, 30});
        depth_list += fmt::format("{}.5 depth/{}\n", i, name);
        colour_list += fmt::format("{}.51 rgb/{}\n", i, name);
    }
    folder.WriteText("depth.txt", depth_list);
    folder.WriteText("rgb.txt", colour_list);
    folder.WriteText("camera.yaml", kSmallCamera);
}

std::unique_ptr<FrameSource> Open(const TemporaryFolder& folder,
                                  const FolderSourceConfig& config = {}) {
    auto source = OpenFolderSource(folder.path(), config);
    EXPECT_TRUE(source.ok()) << source.message();
    return source.ok() ? std::move(source.value()) : nullptr;
}

TEST(FolderSource, GivesEachFrameInMetresWithItsStamps) {
    TemporaryFolder folder;
    WriteSequence(folder, 3);
    folder.WriteText("groundtruth.txt", "1.5 7 0 0 0 0 0 1\n");
    const auto source = Open(folder);
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(source->info().name, folder.path());
    EXPECT_EQ(source->info().frame_count, 3);
    EXPECT_EQ(source->info().camera, (PinholeCamera{32, 24, 30, 31, 15.5, 11.5}));
    EXPECT_TRUE(source->info().has_truth);
    EXPECT_FALSE(source->info().rectified);
    Frame frame;
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
        EXPECT_EQ(frame.index, i);
        EXPECT_EQ(frame.stamp_s, i + 0.5);
        EXPECT_EQ(frame.colour_stamp_s, i + 0.51);
        EXPECT_EQ(frame.depth_m, DepthImage(32, 24, static_cast<float>(i + 1)));
        EXPECT_EQ(frame.colour, ColourImage(32, 24, {static_cast<std::uint8_t>(10 * i), 20, 30}));
        EXPECT_EQ(frame.T_world_camera.has_value(), i == 1);
    }
    EXPECT_EQ(source->Read(frame).status, ReadStatus::kEnd);
    EXPECT_EQ(source->Read(frame).status, ReadStatus::kEnd);
}

TEST(FolderSource, Seeks) {
    TemporaryFolder folder;
    WriteSequence(folder, 3);
    const auto source = Open(folder);
    Frame frame;
    ASSERT_TRUE(source->Seek(2));
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 2);
    ASSERT_TRUE(source->Seek(0));
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 0);
    EXPECT_FALSE(source->Seek(-1));
    EXPECT_FALSE(source->Seek(4));
    EXPECT_EQ(source->Stamps_s(), (std::vector<double>{0.5, 1.5, 2.5}));
}

TEST(FolderSource, CorrectsTheLensUnlessToldNotTo) {
    TemporaryFolder folder;
    WriteSequence(folder, 1);
    folder.WriteText("camera.yaml", std::string(kSmallCamera) + "distortion: [0.5, 0, 0, 0]\n");
    Frame frame;
    auto source = Open(folder);
    EXPECT_TRUE(source->info().lens_corrected);
    EXPECT_TRUE(source->info().rectified);
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.depth_m(0, 0), 0.0f);  // the lens model maps it outside the raw image
    EXPECT_EQ(frame.depth_m(16, 12), 1.0f);
    source = Open(folder, {.rectify = false});
    EXPECT_FALSE(source->info().rectified);
    EXPECT_EQ(source->info().notes.back(), "lens distortion is not corrected, as configured");
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.depth_m(0, 0), 1.0f);
}

// The colour camera is twice as large and sits 0.1 m to the right.
TEST(FolderSource, RegistersAColourCameraOfItsOwn) {
    TemporaryFolder folder;
    WriteSequence(folder, 1);
    ColourImage ramp(64, 48);
    for (int v = 0; v < 48; ++v)
        for (int u = 0; u < 64; ++u)
            ramp(u, v) = {static_cast<std::uint8_t>(4 * u), static_cast<std::uint8_t>(5 * v), 0};
    ASSERT_TRUE(WriteColourImage(folder.Path("rgb/0.png"), ramp).ok());
    EXPECT_FALSE(OpenFolderSource(folder.path(), {}).ok());  // of another size than depth
    folder.WriteText("camera.yaml", std::string(kSmallCamera) +
                                        "colour: {width: 64, height: 48, fx: 30, fy: 31, cx: 30, "
                                        "cy: 20, T_colour_depth: [-0.1, 0, 0, 0, 0, 0, 1]}\n");
    auto source = Open(folder);
    ASSERT_NE(source, nullptr);
    EXPECT_FALSE(source->info().one_camera);
    EXPECT_TRUE(source->info().rectified);
    EXPECT_FALSE(source->info().lens_corrected);
    Frame frame;
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    // Depth 1 m: (16, 12) is seen at 16 - 15.5 + 30 - 3 and 12 - 11.5 + 20.
    EXPECT_EQ(frame.depth_m(16, 12), 1.0f);
    EXPECT_EQ(frame.colour.width(), 32);
    EXPECT_NEAR(frame.colour(16, 12).r, 4 * 27.5, 1);
    EXPECT_NEAR(frame.colour(16, 12).g, 5 * 20.5, 1);
    source = Open(folder, {.colour_shift_px = {2, -1}});
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_NEAR(frame.colour(16, 12).r, 4 * 29.5, 1);
    EXPECT_NEAR(frame.colour(16, 12).g, 5 * 19.5, 1);
    folder.WriteColour("rgb/0.png", 32, 24, {});
    EXPECT_NE(OpenFolderSource(folder.path(), {}).message().find("the colour camera has 64 x 48"),
              std::string::npos);
}

TEST(FolderSource, TheConfiguredDepthScaleComesFirst) {
    TemporaryFolder folder;
    WriteSequence(folder, 1);
    const auto source = Open(folder, {.depth_scale = 500});
    Frame frame;
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.depth_m(3, 3), 2.0f);
    EXPECT_FALSE(OpenFolderSource(folder.path(), {.depth_scale = 1e-9}).ok());
}

TEST(FolderSource, PassesGarbageDepthThrough) {
    TemporaryFolder folder;
    WriteSequence(folder, 2);
    folder.WriteDepth("depth/0.png", 32, 24, 65535);
    folder.WriteDepth("depth/1.png", 32, 24, 0);
    const auto source = Open(folder);
    Frame frame;
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_FLOAT_EQ(frame.depth_m(0, 0), 65.535f);
    ASSERT_EQ(source->Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.depth_m, DepthImage(32, 24, 0.0f));
}

// Each kind of broken image skips only its own frame, and the message names the file.
TEST(FolderSource, SkipsBrokenFramesAndSaysWhy) {
    TemporaryFolder folder;
    WriteSequence(folder, 8);
    const std::string whole = ReadText(folder.Path("depth/1.png"));
    folder.WriteText("depth/1.png", whole.substr(0, whole.size() - 20));
    ASSERT_TRUE(WriteGreyImage(folder.Path("depth/2.png"), Image<std::uint8_t>(32, 24)).ok());
    folder.WriteColour("depth/3.png", 32, 24, {});
    folder.WriteColour("rgb/4.png", 16, 24, {});
    // Known from the header: nothing of a large image is decoded.
    folder.WriteDepth("depth/5.png", 16, 12, 1);
    folder.WriteText("depth/5.png", ReadText(folder.Path("depth/5.png")).substr(0, 50));
    folder.WriteColour("rgb/5.png", 16, 12, {});
    std::filesystem::remove(folder.Path("rgb/6.png"));
    const std::vector<std::string> expected = {
        "",
        folder.Path("depth/1.png") +
            ": is truncated or damaged: too little data for 32 x 24 pixels",
        folder.Path("depth/2.png") +
            ": has 8 bits and 1 channel; depth needs 16 bits and 1 channel",
        folder.Path("depth/3.png") +
            ": has 8 bits and 3 channels; depth needs 16 bits and 1 channel",
        folder.Path("rgb/4.png") + ": 16 x 24 pixels, but its depth image has 32 x 24",
        folder.Path("depth/5.png") +
            ": 16 x 12 pixels, but the camera has 32 x 24; correct camera.yaml",
        folder.Path("rgb/6.png") + ": no such file",
        ""};
    const auto source = Open(folder);
    Frame frame;
    for (const std::string& message : expected) {
        const ReadResult result = source->Read(frame);
        EXPECT_EQ(result.status, message.empty() ? ReadStatus::kOk : ReadStatus::kSkip);
        EXPECT_EQ(result.message, message);
    }
    EXPECT_EQ(frame.index, 7);
    EXPECT_EQ(source->Read(frame).status, ReadStatus::kEnd);
}

TEST(FolderSource, IsRefusedWhereNoFrameIsUsable) {
    TemporaryFolder folder;
    WriteSequence(folder, 7);
    folder.WriteText("camera.yaml", "width: 64\nheight: 24\nfx: 30\nfy: 31\ncx: 15.5\ncy: 11.5\n");
    EXPECT_EQ(OpenFolderSource(folder.path(), {}).message(),
              folder.Path("depth/0.png") +
                  ": 32 x 24 pixels, but the camera has 64 x 24; correct camera.yaml");
    folder.WriteText("camera.yaml", "width: 64\nfx: nonsense\n");
    EXPECT_EQ(
        OpenFolderSource(folder.path(), {}).message().find(folder.Path("camera.yaml") + ": fx"),
        0u);
}

// The assumed field of view is 60 degrees. TUM depths are whole millimetres times five.
TEST(FolderSource, AssumesACameraWhereNobodyGaveOne) {
    for (const auto& [value, unit] :
         {std::pair<std::uint16_t, double>{1501, 1000}, {1500, 5000}, {7502, 5000}}) {
        TemporaryFolder folder;
        WriteSequence(folder, 3);
        std::filesystem::remove(folder.Path("camera.yaml"));
        for (int i = 0; i < 3; ++i)
            folder.WriteDepth("depth/" + std::to_string(i) + ".png", 32, 24, value);
        const auto source = OpenFolderSource(folder.path(), {});
        ASSERT_TRUE(source.ok()) << source.message();
        const SourceInfo& info = source.value()->info();
        EXPECT_FALSE(info.camera_known);
        EXPECT_NEAR(info.camera.fx, 16 * std::sqrt(3.0), 1e-9);
        EXPECT_EQ(info.camera.cx, 15.5);
        EXPECT_EQ(info.depth_units_per_m, unit);
    }
}

TEST(FolderSource, AssumesNoDepthUnitWhereTheUserHasSetIt) {
    TemporaryFolder folder;
    WriteSequence(folder, 1);
    folder.WriteText("camera.yaml", "width: 32\nheight: 24\nfx: 30\nfy: 31\ncx: 15\ncy: 11\n");
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(Open(folder)->info().notes.size(), 1u);
        EXPECT_TRUE(Open(folder, {.depth_scale = 2000})->info().notes.empty());
        std::filesystem::remove(folder.Path("camera.yaml"));
    }
}

TEST(FolderSource, TakesTheProgramsCameraInPlaceOfTheFiles) {
    TemporaryFolder folder;
    WriteSequence(folder, 1);
    FolderSourceConfig config;
    config.camera = PinholeCamera{1, 1, 40, 41, 15, 11};
    const auto source = OpenFolderSource(folder.path(), config);
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_EQ(source.value()->info().camera, (PinholeCamera{32, 24, 40, 41, 15, 11}));
}

TEST(FolderSourceConfig, DescribesItself) {
    FolderSourceConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    EXPECT_TRUE(parameters.Set("depth_scale", "1000").ok());
    EXPECT_TRUE(parameters.Set("rectify", "off").ok());
    EXPECT_FALSE(parameters.Set("max_pair_gap_s", "-1").ok());
    EXPECT_EQ(config.depth_scale, 1000);
    EXPECT_FALSE(config.rectify);
    EXPECT_TRUE(config.Validate().ok());
}

}  // namespace
}  // namespace tessera
