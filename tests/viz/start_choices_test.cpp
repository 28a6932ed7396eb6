#include "viz/start_choices.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "support/temp_folder.h"
#include "system/run_config.h"

namespace tessera {
namespace {

using Words = std::vector<std::string>;

StartChoices Plain() {
    StartChoices choices;
    choices.path = "desk";
    choices.output_folder = "out";
    return choices;
}

TEST(StartChoices, DefaultsAreLeftOut) {
    EXPECT_EQ(RunWords(Plain()), (Words{"tessera", "run", "desk", "--out", "out", "--view"}));
    EXPECT_EQ(ViewWords(Plain()), (Words{"tessera", "view", "desk"}));
}

TEST(StartChoices, EachChoiceIsAnOption) {
    StartChoices choices = Plain();
    choices.quality = StartQuality::kFast;
    choices.loops = false;
    choices.labels = "models/a.onnx";
    EXPECT_EQ(RunWords(choices),
              (Words{"tessera", "run", "desk", "--out", "out", "--view", "--set",
                     "mapping.voxel_size_m=0.02", "--set", "mapping.truncation_m=0.08",
                     "--loop-closure", "off", "--labels", "models/a.onnx"}));
}

TEST(StartChoices, SourcesOfEachPage) {
    StartChoices choices = Plain();
    choices.page = StartPage::kDemo;
    choices.scene = "room";
    EXPECT_EQ(SourceOf(choices), "synthetic:room");
    choices.page = StartPage::kCamera;
    EXPECT_EQ(SourceOf(choices), "");
    choices.camera = "1d27/0609@1/5";
    EXPECT_EQ(SourceOf(choices), "openni2:1d27/0609@1/5");
}

TEST(StartChoices, ANameWithADashIsNoOption) {
    StartChoices choices = Plain();
    choices.path = choices.output_folder = "--help";
    EXPECT_EQ(RunWords(choices),
              (Words{"tessera", "run", "./--help", "--out", "./--help", "--view"}));
}

TEST(StartChoices, TheHomeFolderIsFilledIn) {
    setenv("HOME", "/home/me", 1);
    StartChoices choices = Plain();
    choices.path = "~/desk";
    EXPECT_EQ(SourceOf(choices), "/home/me/desk");
    choices.output_folder = "~/out";
    EXPECT_EQ(OutputFolderOf(choices), "/home/me/out");
    EXPECT_EQ(RunWords(choices).at(4), "/home/me/out");
    choices.path = "a~/desk";
    EXPECT_EQ(SourceOf(choices), "a~/desk");
}

// The qualities are settings that a run accepts; Normal is what it does without them.
TEST(StartChoices, QualitiesAreValid) {
    for (const QualityInfo& info : StartQualities()) {
        EXPECT_EQ(&InfoOf(info.quality), &info);
        RunConfig config;
        ConfigParameters parameters;
        config.Describe(parameters);
        ASSERT_TRUE(parameters.Set("mapping.voxel_size_m", info.voxel_size_m).ok());
        ASSERT_TRUE(parameters.Set("mapping.truncation_m", info.truncation_m).ok());
        EXPECT_TRUE(config.Validate().ok()) << info.name;
        EXPECT_DOUBLE_EQ(config.pipeline.map.truncation_m, 4 * config.pipeline.map.voxel_size_m);
        if (info.quality != StartQuality::kNormal) continue;
        EXPECT_EQ(config.pipeline.map.voxel_size_m, RunConfig().pipeline.map.voxel_size_m);
        EXPECT_EQ(config.pipeline.map.truncation_m, RunConfig().pipeline.map.truncation_m);
    }
}

TEST(StartChoices, TheOutputFolderIsNew) {
    const TempFolder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const std::string first = NewOutputFolder();
    std::filesystem::create_directory(first);
    const std::string second = NewOutputFolder();
    std::filesystem::current_path(before);
    EXPECT_TRUE(first.starts_with("scan-20")) << first;
    EXPECT_NE(first, second);
}

}  // namespace
}  // namespace tessera
