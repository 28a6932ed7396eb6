#include "semantics/label_config.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

namespace tessera {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

// Splits "a=b c" into pairs; the second part of "c" is empty.
Pairs SplitPairs(const std::string& text) {
    Pairs pairs;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const std::size_t equals = word.find('=');
        pairs.emplace_back(word.substr(0, equals),
                           equals == std::string::npos ? "" : word.substr(equals + 1));
    }
    return pairs;
}

std::optional<Rgb8> ParseColour(const std::string& text) {
    if (text.size() != 7 || text[0] != '#' ||
        text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
        return std::nullopt;
    const auto value = static_cast<std::uint32_t>(std::strtoul(text.c_str() + 1, nullptr, 16));
    return Rgb8{static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255),
                static_cast<std::uint8_t>(value & 255)};
}

std::string WithoutBlanks(std::string name) {
    std::ranges::replace(name, ' ', '_');
    return name;
}

}  // namespace

Rgb8 DistinctColour(int n) {
    constexpr double kGoldenTurn = 0.6180339887;
    const double hue = 6 * std::fmod(0.02 + n * kGoldenTurn, 1.0);
    const double low = n / 5 % 2 == 0 ? 0.22 : 0.42, high = n / 10 % 2 == 0 ? 0.95 : 0.75;
    const auto channel = [&](double shift) {
        const double k = std::fmod(shift + hue, 6.0);
        const double part = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
        return static_cast<std::uint8_t>(std::lround(255 * (high - (high - low) * part)));
    };
    return {channel(5), channel(3), channel(1)};
}

void LabelConfig::Describe(ConfigParameters& p) {
    p.Add("classes", classes,
          "classes to label, separated by blanks, each with an optional colour (cup=#b146c2); "
          "write _ for a blank in a name; all stands for every class of the detector");
    p.Add("aliases", aliases,
          "renames classes: the detector's name=our name, separated by blanks; a name that is in "
          "labels.classes or labels.dynamic is kept");
    p.Add("dynamic", dynamic,
          "classes that may move at any time, separated by blanks; their pixels are neither fused, "
          "even while the object stands still, nor labelled");
    p.Add("min_probability", min_probability, {0.0, 1.0}, "",
          "detections below this probability are ignored; [D18] uses 0.5");
    p.AddChoice<LabelRegion>(
        "region", region,
        {{"segment", LabelRegion::kSegment}, {"mean-depth", LabelRegion::kMeanDepth}},
        "which pixels of a box belong to the object: its connected depth segment (or the model's "
        "mask), or all that are not deeper than the mean depth of the box ([D18])");
    p.AddChoice(
        "prediction", prediction,
        {{"raycast", LabelPrediction::kRayCast}, {"raster", LabelPrediction::kRaster}},
        "source of the view with which detections are compared: ray casting of the labelled "
        "field, or its mesh drawn by OpenGL ([D18]); without OpenGL the ray caster is used "
        "instead");
    p.Add("band_voxels", band_voxels, {0.9, 10.0}, "voxels",
          "voxels this close to the surface get votes");
    p.Add("min_observations", min_observations, {1, 1000}, "",
          "detections needed to confirm an object");
    p.Add("min_rate", min_rate, {0.0, 1.0}, "",
          "an object also needs detections in this share of the processed frames that show it");
    p.Add("stride", stride, {1, 1000}, "frames",
          "lockstep mode: run the detector on every N-th frame; live mode runs it as often as it "
          "can");
    p.Add("max_rate_hz", max_rate_hz, {0.1, 1000.0}, "1/s",
          "live mode: run the detector on at most this many frames per second, so that tracking "
          "keeps its CPU time; raise it on a machine with cores to spare");
    p.AddChoice<ModelFamily>(
        "family", family,
        {{"auto", ModelFamily::kAuto},
         {"yolox", ModelFamily::kYolox},
         {"yolov5", ModelFamily::kYolov5},
         {"yolov8", ModelFamily::kYolov8},
         {"darknet", ModelFamily::kDarknet}},
        "how to decode the network's outputs; auto recognises the family by their shapes; run with "
        "a real model: yolox; the others follow their documented layouts and were tested on "
        "made-up outputs");
    p.Add("names", names,
          "file with the network's class names, one per line; empty: the 80 COCO classes");
    p.Add("input_px", input_px, {0, 4096}, "px",
          "side length of the network's square input, a multiple of 32; 0 tries 416, 640 and 320");
    p.Add("overlap", overlap, {0.0, 1.0}, "",
          "if two boxes of one class overlap by more than this (intersection over union), the less "
          "probable one is removed; in a detections file, two of the same name only above 0.8");
    p.Add("synthetic_missed", synthetic_missed, {0.0, 1.0}, "",
          "share of detections that --labels synthetic omits");
    p.Add("synthetic_wrong", synthetic_wrong, {0.0, 1.0}, "",
          "share of detections to which --labels synthetic gives a wrong class");
    p.Add("synthetic_seed", synthetic_seed, {0, 2147483647}, "", "random seed of these errors");
}

Status LabelConfig::Validate() const {
    if (input_px % 32 != 0)
        return Status::Error(fmt::format("labels.input_px: {} is not a multiple of 32", input_px));
    const Result<LabelClasses> made = LabelClasses::Make(*this, {});
    return made.status();
}

void LabelClasses::Add(const std::string& name, Rgb8 colour) {
    ids_[name] = static_cast<int>(names_.size());
    names_.push_back(name);
    colours_.push_back(colour);
}

Result<LabelClasses> LabelClasses::Make(const LabelConfig& config,
                                        const std::vector<std::string>& known) {
    LabelClasses made;
    Result<ClassAliases> aliases = ParseAliases(config.aliases);
    if (!aliases.ok()) return Status::Error("labels.aliases: " + aliases.message());
    made.aliases_ = std::move(aliases.value());
    for (const auto& [name, colour] : SplitPairs(config.dynamic)) {
        if (name.empty() || !colour.empty())
            return Status::Error("labels.dynamic: '" + name + "=" + colour + "' is not a NAME");
        made.dynamic_.insert(name);
    }
    Pairs wanted = SplitPairs(config.classes);
    const bool all =
        std::ranges::any_of(wanted, [](const auto& entry) { return entry.first == "all"; });
    std::erase_if(wanted, [](const auto& entry) { return entry.first == "all"; });
    std::erase_if(made.aliases_, [&](const auto& alias) {
        return made.dynamic_.contains(alias.first) ||
               std::ranges::find(wanted, alias.first, &Pairs::value_type::first) != wanted.end();
    });
    if (all)
        for (const std::string& name : known)
            if (std::ranges::none_of(
                    wanted, [&](const auto& entry) { return entry.first == made.OurName(name); }))
                wanted.emplace_back(made.OurName(name), "");
    if (wanted.empty() && !all) return Status::Error("labels.classes: names no class");
    for (const auto& [name, colour] : wanted) {
        if (name.empty() || made.ids_.contains(name))
            return Status::Error("labels.classes: '" + name + "' is empty or given twice");
        const auto rgb = colour.empty() ? DistinctColour(made.count()) : ParseColour(colour);
        if (!rgb)
            return Status::Error(
                fmt::format("labels.classes: {}={}: expected a colour as #rrggbb", name, colour));
        made.Add(name, *rgb);
    }
    if (made.count() > kMost)
        return Status::Error(
            fmt::format("labels.classes: {} classes, at most {}", made.count(), kMost));
    made.SetKnown(known);
    if (!known.empty() && made.known_ids_.empty())
        return Status::Error(
            fmt::format("labels.classes: the detector knows none of them (it knows {}{}); set "
                        "labels.classes or "
                        "labels.aliases, or labels.classes=all",
                        known.front(), known.size() > 1 ? ", ..." : ""));
    return made;
}

void LabelClasses::SetKnown(const std::vector<std::string>& known) {
    known_ids_.clear();
    for (const std::string& name : known)
        if (IdOf(name) > 0) known_ids_.insert(IdOf(name));
}

std::string LabelClasses::OurName(const std::string& detector_name) const {
    return Renamed(aliases_, WithoutBlanks(detector_name));
}

int LabelClasses::IdOf(const std::string& detector_name) const {
    const auto found = ids_.find(OurName(detector_name));
    return found == ids_.end() ? 0 : found->second;
}

bool LabelClasses::IsDynamic(const std::string& detector_name) const {
    return dynamic_.contains(OurName(detector_name));
}

bool LabelClasses::CanBeFound(int id) const {
    return !dynamic_.contains(name(id)) && (known_ids_.empty() || known_ids_.contains(id));
}

std::string WarningOf(const LabelConfig& config, const LabelClasses& classes) {
    if (config.classes == LabelConfig().classes) return {};
    std::string names;
    for (const auto& [name, colour] : SplitPairs(config.classes))
        if (const int id = classes.IdOf(name); id != 0 && !classes.CanBeFound(id))
            names += (names.empty() ? "" : ", ") + name;
    if (names.empty()) return {};
    return "labels.classes: the detector does not know, or labels.dynamic takes: " + names;
}

}  // namespace tessera
