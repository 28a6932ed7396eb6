#include "core/config.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

enum class Weight { kConstant, kLinearExp };

struct Settings {
    double voxel_size_m = 0.01;
    int iterations = 5;
    bool gamma = false;
    std::string folder = "out";
    Weight weight = Weight::kConstant;

    void Describe(ConfigParameters& parameters) {
        parameters.Add("folder", folder, "Where results go.");
        parameters.Section("mapping", [&](ConfigParameters& p) {
            p.Add("voxel_size_m", voxel_size_m, {0.001, 1}, "m", "Edge of a voxel.");
            p.AddChoice("weight", weight,
                        {{"constant", Weight::kConstant}, {"linear_exp", Weight::kLinearExp}},
                        "Weighting.");
        });
        parameters.Section("tracking", [&](ConfigParameters& p) {
            p.Add("iterations", iterations, {1, 100}, "", "Steps per level.");
            p.Add("gamma", gamma, "Brightness.");
        });
    }
};

class Config : public testing::Test {
  protected:
    void SetUp() override { settings.Describe(parameters); }
    Settings settings;
    ConfigParameters parameters;
};

TEST_F(Config, SetsEveryKind) {
    EXPECT_TRUE(parameters.Set("mapping.voxel_size_m", "0.02").ok());
    EXPECT_TRUE(parameters.Set("mapping.weight", "linear_exp").ok());
    EXPECT_TRUE(parameters.Set("tracking.iterations", "7").ok());
    EXPECT_TRUE(parameters.Set("tracking.gamma", "on").ok());
    EXPECT_TRUE(parameters.Set("folder", "a b: #c").ok());
    EXPECT_EQ(settings.voxel_size_m, 0.02);
    EXPECT_EQ(settings.weight, Weight::kLinearExp);
    EXPECT_EQ(settings.iterations, 7);
    EXPECT_TRUE(settings.gamma);
    EXPECT_EQ(settings.folder, "a b: #c");
}

TEST_F(Config, BothEndsOfARangeAreAllowedAndNothingBeyond) {
    for (const char* good : {"0.001", "1", "1e-2"})
        EXPECT_TRUE(parameters.Set("mapping.voxel_size_m", good).ok()) << good;
    settings.voxel_size_m = 0.5;
    for (const char* bad :
         {"0.0009", "1.01", "-1", "nan", "inf", "1 cm", "", " 0.1", "0,1", "1e999"}) {
        const Status status = parameters.Set("mapping.voxel_size_m", bad);
        EXPECT_FALSE(status.ok()) << bad;
        EXPECT_NE(status.message().find("mapping.voxel_size_m"), std::string::npos);
        EXPECT_NE(status.message().find("[0.001, 1]"), std::string::npos) << status.message();
    }
    EXPECT_EQ(settings.voxel_size_m, 0.5);
    for (const char* bad : {"0", "101", "2.5", "99999999999", "x"})
        EXPECT_FALSE(parameters.Set("tracking.iterations", bad).ok()) << bad;
    EXPECT_EQ(settings.iterations, 5);
}

TEST_F(Config, ChoicesAndSwitchesNameWhatIsAllowed) {
    const Status weight = parameters.Set("mapping.weight", "linear");
    EXPECT_EQ(weight.message(), "mapping.weight: 'linear' is not one of constant | linear_exp");
    EXPECT_FALSE(parameters.Set("tracking.gamma", "maybe").ok());
}

TEST_F(Config, AnUnknownKeyNamesTheNearest) {
    const auto nearest = [&](const std::string& key) { return parameters.Set(key, "1").message(); };
    EXPECT_EQ(
        nearest("mapping.voxel_size"),
        "unknown configuration key 'mapping.voxel_size'; did you mean 'mapping.voxel_size_m'?");
    EXPECT_NE(nearest("iterations").find("'tracking.iterations'"), std::string::npos);
    EXPECT_NE(nearest("mapping.gama").find("'tracking.gamma'"), std::string::npos);
}

TEST_F(Config, MarkdownHoldsEveryKeyWithItsDefault) {
    settings.voxel_size_m = 0.7;  // does not change the default described above
    const std::string markdown = parameters.ToMarkdown();
    EXPECT_NE(markdown.find("## mapping"), std::string::npos);
    EXPECT_NE(markdown.find("| `voxel_size_m` | 0.01 | m | [0.001, 1] | Edge of a voxel. |"),
              std::string::npos)
        << markdown;
    EXPECT_NE(markdown.find("constant, linear_exp"), std::string::npos);
}

using ConfigDeath = Config;
TEST_F(ConfigDeath, AKeyDescribedTwiceIsABug) {
    EXPECT_DEATH(settings.Describe(parameters), "folder is described twice");
}

}  // namespace
}  // namespace tessera
