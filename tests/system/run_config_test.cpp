#include "system/run_config.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace tessera {
namespace {

TEST(RunConfig, TheDefaultsAreValid) { EXPECT_TRUE(RunConfig().Validate().ok()); }

TEST(RunConfig, EveryParameterSaysWhatItDoes) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    EXPECT_GT(parameters.parameters().size(), 30u);
    for (const auto& parameter : parameters.parameters()) {
        EXPECT_GT(parameter.documentation.size(), 10u) << parameter.key;
        EXPECT_EQ(parameter.documentation.find('|'), std::string::npos)
            << parameter.key << ": breaks the Markdown table";
        // A default outside its own range could not be read back from run.json or from the output
        // of `tessera config`.
        EXPECT_TRUE(parameter.set(parameter.default_value).ok()) << parameter.key;
    }
}

TEST(RunConfig, EveryPresetLoadsAndIsValid) {
    for (const Preset& preset : Presets()) {
        RunConfig config;
        ConfigParameters parameters;
        config.Describe(parameters);
        const Status status = LoadPresetOrFile(preset.name, parameters);
        EXPECT_TRUE(status.ok()) << status.message();
        EXPECT_TRUE(config.Validate().ok()) << config.Validate().message();
    }
}

TEST(RunConfig, AnUnknownPresetNamesTheKnownOnes) {
    ConfigParameters parameters;
    EXPECT_EQ(LoadPresetOrFile("bylow", parameters).message(),
              "bylow: neither a file nor a preset (default, bylow2014, diaz2018, labels)");
}

TEST(RunConfig, TheDocumentIsUpToDate) {
    std::ifstream file(TESSERA_SOURCE_DIR "/docs/configuration.md");
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_TRUE(text.str() == ConfigurationDocument())
        << "run: build/release/apps/tessera config --markdown > docs/configuration.md";
}

}  // namespace
}  // namespace tessera
