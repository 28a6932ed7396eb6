#include "viz/start_choices.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "io/openni_devices.h"

namespace tessera {
namespace {

// As a shell would hand it over. A name that begins with a dash would be an option.
std::string AsArgument(const std::string& path) {
    const char* home = std::getenv("HOME");
    if (path.starts_with("~/") && home != nullptr) return home + path.substr(1);
    return path.starts_with('-') ? "./" + path : path;
}

}  // namespace

const std::vector<QualityInfo>& StartQualities() {
    static const std::vector<QualityInfo> kQualities{
        {StartQuality::kFast, "fast", "Fast", "0.02", "0.08",
         "Voxels of 2 cm: a quarter of the memory, a little faster. For large rooms; small things "
         "are lost."},
        {StartQuality::kNormal, "normal", "Normal", "0.01", "0.04",
         "Voxels of 1 cm: for rooms and furniture. Two processor cores are enough."},
        {StartQuality::kFine, "fine", "Fine", "0.005", "0.02",
         "Voxels of 5 mm: four times the memory, half as long again per frame. For single "
         "objects."}};
    return kQualities;
}

const QualityInfo& InfoOf(StartQuality quality) {
    return StartQualities()[static_cast<std::size_t>(quality)];
}

const std::vector<DemoScene>& DemoScenes() {
    static const std::vector<DemoScene> kScenes{
        {"desk", "A desk with monitors, books and cups. 10 s."},
        {"room", "A furnished room, once around. 24 s."},
        {"flat", "Two rooms joined by doorways, once around. 80 s."}};
    return kScenes;
}

std::string SourceOf(const StartChoices& choices) {
    switch (choices.page) {
        case StartPage::kCamera:
            return choices.camera.empty() ? "" : kOpenniPrefix + choices.camera;
        case StartPage::kDemo: return "synthetic:" + choices.scene;
        case StartPage::kFiles: return AsArgument(choices.path);
    }
    return "";
}

std::string OutputFolderOf(const StartChoices& choices) {
    return AsArgument(choices.output_folder);
}

std::vector<std::string> RunWords(const StartChoices& choices) {
    std::vector<std::string> words{
        "tessera", "run", SourceOf(choices), "--out", OutputFolderOf(choices), "--view"};
    const auto add = [&](const char* option, const std::string& value) {
        words.push_back(option);
        words.push_back(value);
    };
    if (choices.quality != StartQuality::kNormal) {
        const QualityInfo& info = InfoOf(choices.quality);
        add("--set", fmt::format("mapping.voxel_size_m={}", info.voxel_size_m));
        add("--set", fmt::format("mapping.truncation_m={}", info.truncation_m));
    }
    if (!choices.loops) add("--loop-closure", "off");
    if (!choices.labels.empty()) add("--labels", AsArgument(choices.labels));
    return words;
}

std::vector<std::string> ViewWords(const StartChoices& choices) {
    return {"tessera", "view", SourceOf(choices)};
}

std::string NewOutputFolder() {
    const std::string stem =
        fmt::format("scan-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
    std::string name = stem;
    std::error_code ignored;
    for (int i = 2; std::filesystem::exists(name, ignored); ++i)
        name = fmt::format("{}-{}", stem, i);
    return name;
}

}  // namespace tessera
