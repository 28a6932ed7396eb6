// The methods by name, what they share, and how each is made: the one place that knows them all.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/camera.h"
#include "core/config.h"
#include "system/device.h"
#include "tracking/icp_tracker.h"
#include "tracking/residual_model.h"
#include "tracking/sdf_tracker.h"
#include "tracking/track_judge.h"
#include "tracking/tracker.h"

namespace tessera {

enum class TrackingMethod { kSdf, kSdfGeometric, kIcp, kIcpRgb };
inline constexpr int kTrackingMethods = 4;
const char* ToString(TrackingMethod method);
// The names, in the order of the enumeration.
std::vector<std::pair<std::string, TrackingMethod>> TrackingMethodNames();

struct TrackersConfig {
    TrackingMethod method = TrackingMethod::kSdf;
    double even_within_m = 0.004;
    TrackJudge::Config judge;
    ResidualModel::Config photometric;
    SdfTracker::Config sdf;
    IcpTracker::Config icp;

    void Describe(ConfigParameters& parameters);
};

// The rasteriser where it is asked for and works here, else the ray caster; `note` says so in words
// if it steps in.
std::unique_ptr<ViewPredictor> MakePredictor(IcpTracker::Prediction prediction, std::string& note);

// All methods over one camera, switchable between two frames: what residuals teach is theirs
// together. Owner thread only.
class Trackers {
  public:
    // `device` outlives them; null: all on the processor.
    Trackers(const TrackersConfig& config, const PinholeCamera& camera, Device* device = nullptr);

    TrackingMethod method() const { return method_; }
    void Select(TrackingMethod method) { method_ = method; }
    // Whether the selected method reads the voxels of TrackInput::map, not only the device's.
    bool reads_map() const;
    // By the selected method; made when it is first needed, on the thread that tracks.
    TrackResult Track(const TrackInput& input);
    // In place of the configuration's: learnt from the frames, or this, in m^2.
    void SetAlpha(bool automatic, double alpha) { model_.SetAlpha(automatic, alpha); }
    // Forgets what was learnt, keeps the choices.
    void Reset() { model_.Reset(); }
    // What was learnt.
    void SaveState(StateWriter& state) const { model_.SaveState(state); }
    bool LoadState(StateReader& state) { return model_.LoadState(state); }
    // What a person should know of how the methods came up, in words, once; mostly empty.
    std::string TakeNote();

  private:
    std::unique_ptr<Tracker> Make(TrackingMethod method);

    TrackersConfig config_;
    PinholeCamera camera_;
    Device* device_;
    TrackingMethod method_;
    ResidualModel model_;
    std::array<std::unique_ptr<Tracker>, kTrackingMethods> trackers_;
    std::string note_;
};

}  // namespace tessera
