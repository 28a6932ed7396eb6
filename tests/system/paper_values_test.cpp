// Every value of the presets bylow2014 and diaz2018 is in docs/papers.md, with its source.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <string>

#include "system/run_config.h"

namespace tessera {
namespace {

struct PaperPage {
    std::map<std::string, std::string> value;  // of each key
    std::set<std::string> unused;              // keys that do nothing with this preset
};

// Reads the section of a preset: rows "| ... | `key` | value |", and keys after "Without effect:".
PaperPage ReadPage(const std::string& preset) {
    std::ifstream file(TESSERA_SOURCE_DIR "/docs/papers.md");
    PaperPage page;
    std::string line;
    bool inside = false, unused = false;
    const auto quoted = [](const std::string& text, std::size_t& at) {
        const std::size_t begin = text.find('`', at);
        const std::size_t end = begin == std::string::npos ? begin : text.find('`', begin + 1);
        if (end == std::string::npos) return std::string();
        at = end + 1;
        return text.substr(begin + 1, end - begin - 1);
    };
    while (std::getline(file, line)) {
        if (line.starts_with("## ")) inside = line == "## " + preset;
        if (!inside) continue;
        if (line.empty() || line.starts_with("|")) unused = false;
        if (line.starts_with("Without effect:")) unused = true;
        std::size_t at = 0;
        if (unused)
            for (std::string key = quoted(line, at); !key.empty(); key = quoted(line, at))
                page.unused.insert(key);
        else if (line.starts_with("| ") && line.find('`') != std::string::npos) {
            const std::string key = quoted(line, at);
            std::string value = quoted(line, at);
            EXPECT_TRUE(page.value.emplace(key, value).second) << key << " is listed twice";
        }
    }
    return page;
}

// The label settings that [D18] speaks of.
std::set<std::string> LabelKeys() {
    return {"labels.classes", "labels.min_probability", "labels.region", "labels.prediction",
            "labels.dynamic"};
}

class Paper : public testing::TestWithParam<const char*> {};

TEST_P(Paper, SaysWhereEveryValueIsFrom) {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    ASSERT_TRUE(LoadPresetOrFile(GetParam(), parameters).ok());
    const PaperPage page = ReadPage(GetParam());
    ASSERT_FALSE(page.value.empty()) << "docs/papers.md has no section ## " << GetParam();
    std::set<std::string> known;
    for (const ConfigParameters::Parameter& p : parameters.parameters()) {
        bool relevant = LabelKeys().contains(p.key) || p.key == "loops.enabled";
        for (const char* section : {"frame.", "mapping.", "tracking.", "moving.", "calibration."})
            relevant = relevant || p.key.starts_with(section);
        if (!relevant) continue;
        const auto found = page.value.find(p.key);
        const bool unused = page.unused.contains(p.key);
        EXPECT_TRUE((found != page.value.end()) != unused)
            << p.key << " = " << p.get() << " is to be listed once in docs/papers.md";
        known.insert(p.key);
        if (found == page.value.end()) continue;
        ConfigParameters::Parameter same = p;
        const std::string now = p.get();
        EXPECT_TRUE(same.set(found->second).ok()) << p.key;
        EXPECT_EQ(p.get(), now) << p.key << " is " << found->second << " in docs/papers.md";
    }
    for (const auto& [key, value] : page.value) EXPECT_TRUE(known.contains(key)) << key;
    for (const std::string& key : page.unused) EXPECT_TRUE(known.contains(key)) << key;
}

INSTANTIATE_TEST_SUITE_P(Presets, Paper, testing::Values("bylow2014", "diaz2018"));

}  // namespace
}  // namespace tessera
