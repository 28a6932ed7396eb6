// Which objects to look for in the images, and with what confidence: section `labels` of the
// configuration. Not modified after reading; thread-safe to read.
#pragma once

#include <bitset>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/image.h"
#include "core/status.h"
#include "io/detections_text.h"

namespace tessera {

// Which pixels of a detection's box belong to the object.
enum class LabelRegion {
    // Its connected depth segment (depth_segment.h), or the model's mask if there is one.
    kSegment,
    kMeanDepth,  // all that is not deeper than the mean depth of the box: [D18] 3.3
};

// Source of the view that shows which instances the map has where ([D18] 3.4).
enum class LabelPrediction { kRayCast, kRaster };

// How to decode a network's outputs (yolo_outputs.h).
enum class ModelFamily { kAuto, kYolox, kYolov5, kYolov8, kDarknet };

struct LabelConfig {
    // "name" or "name=#rrggbb", separated by blanks; "all" stands for every class of the detector.
    std::string classes =
        "computer=#e6403a laptop=#f5a623 keyboard=#3cb44b book=#4363d8 cup=#b146c2";
    // "detector's name=our name", separated by blanks. A name that `classes` or `dynamic` lists is
    // not renamed.
    std::string aliases = "tv=computer tvmonitor=computer monitor=computer";
    std::string dynamic = "person";  // names as in `classes`, without colours
    double min_probability = 0.5;    // [D18] 3.3
    LabelRegion region = LabelRegion::kSegment;
    LabelPrediction prediction = LabelPrediction::kRayCast;
    double band_voxels = 1.5;
    int min_observations = 6;
    double min_rate = 0.3;
    int stride = 1;
    double max_rate_hz = 3;
    double overlap = 0.45;
    // For network detectors.
    ModelFamily family = ModelFamily::kAuto;
    std::string names;
    int input_px = 0;
    // For --labels synthetic.
    double synthetic_missed = 0.1, synthetic_wrong = 0.03;
    int synthetic_seed = 1;

    void Describe(ConfigParameters& parameters);
    // Errors name the key and the value that is wrong.
    Status Validate() const;
};

// The classes of one run, numbered from 1; 0 = none of them.
class LabelClasses {
  public:
    static constexpr int kMost = 250;

    LabelClasses() = default;
    // `known`: the detector's class names, which "all" expands to. An error names the key, or says
    // that there are too many classes or that the detector knows none of them. If `known` is empty,
    // the last check is skipped.
    static Result<LabelClasses> Make(const LabelConfig& config,
                                     const std::vector<std::string>& known);

    // The class names of another detector, which has taken over; for CanBeFound.
    void SetKnown(const std::vector<std::string>& known);

    // Blanks and "_" are equivalent; aliases are applied. Returns 0 if the class is not wanted.
    int IdOf(const std::string& detector_name) const;
    // True for classes of labels.dynamic, by the same name rules. They are kept out of the map and
    // its labels.
    bool IsDynamic(const std::string& detector_name) const;
    // False if the detector has no name for this class, as far as `known` says, or if the class is
    // dynamic.
    bool CanBeFound(int id) const;

    int count() const { return static_cast<int>(names_.size()) - 1; }
    // `id` in [0, count].
    const std::string& name(int id) const { return names_[static_cast<std::size_t>(id)]; }
    Rgb8 colour(int id) const { return colours_[static_cast<std::size_t>(id)]; }
    const ClassAliases& aliases() const { return aliases_; }  // those in use

  private:
    void Add(const std::string& name, Rgb8 colour);
    std::string OurName(const std::string& detector_name) const;

    std::vector<std::string> names_{""};
    std::vector<Rgb8> colours_{Rgb8{90, 90, 90}};
    std::map<std::string, int> ids_;
    ClassAliases aliases_;
    std::set<std::string> dynamic_;
    std::set<int> known_ids_;  // empty: all
};

using ClassSet = std::bitset<LabelClasses::kMost + 1>;  // by number

// What can be changed during a run.
struct LabelSettings {
    bool on = true;  // off: no further frame is passed to the detector
    LabelPrediction prediction = LabelPrediction::kRayCast;
    ClassSet ignored;  // classes whose detections are dropped
};

// What the user should know of the classes that labels.classes names: which of them cannot be
// found. Usually empty; also for the default list, which is made for no particular detector.
std::string WarningOf(const LabelConfig& config, const LabelClasses& classes);

// Neighbouring numbers get distinct colours; the colour of n never changes.
Rgb8 DistinctColour(int n);

}  // namespace tessera
