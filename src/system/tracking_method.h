// The tracking methods: their names, their shared state, and how each is created. The only place
// that knows them all.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/config.h"
#include "render/mesh_rasteriser.h"
#include "system/backend.h"
#include "tracking/icp_tracker.h"
#include "tracking/residual_model.h"
#include "tracking/sdf_tracker.h"
#include "tracking/track_judge.h"
#include "tracking/tracker.h"

namespace tessera {

enum class TrackingMethod { kSdf, kSdfGeometric, kIcp, kIcpRgb };

// Whether a method also compares colours, and what a person sees of it: its name in commands and
// files, its button in the window and the button's tooltip.
struct TrackingMethodInfo {
    TrackingMethod method;
    bool colour;
    const char *name, *label, *tip;
};
// All methods, in the order of the enumeration.
inline constexpr std::array kTrackingMethods = {
    TrackingMethodInfo{TrackingMethod::kSdf, true, "sdf", "SDF + colour",
                       "Signed distance field and intensities, [B14]"},
    TrackingMethodInfo{TrackingMethod::kSdfGeometric, false, "sdf-geometric", "SDF",
                       "Signed distance field only, [B13]"},
    TrackingMethodInfo{TrackingMethod::kIcp, false, "icp", "ICP",
                       "Point-to-plane ICP against a predicted view, [D18]"},
    TrackingMethodInfo{TrackingMethod::kIcpRgb, true, "icp-rgb", "ICP + colour",
                       "Point-to-plane ICP with intensities"},
};
static_assert(
    [] {
        for (std::size_t i = 0; i < kTrackingMethods.size(); ++i)
            if (kTrackingMethods[i].method != static_cast<TrackingMethod>(i)) return false;
        return true;
    }(),
    "the rows are in the order of the enumeration");
constexpr const TrackingMethodInfo& InfoOf(TrackingMethod method) {
    return kTrackingMethods[static_cast<std::size_t>(method)];
}
const char* ToString(TrackingMethod method);
// The names, in the order of the enumeration.
std::vector<std::string> TrackingMethodNames();
// Empty if no method has that name.
std::optional<TrackingMethod> TrackingMethodOf(std::string_view name);

struct TrackersConfig {
    TrackingMethod method = TrackingMethod::kSdf;
    double even_within_m = 0.004;
    TrackJudge::Config judge;
    ResidualModel::Config photometric;
    SdfTracker::Config sdf;
    IcpTracker::Config icp;

    void Describe(ConfigParameters& parameters);
    // What a copy of the map needs for these trackers.
    BlockMap::Layers layers() const {
        return sdf.chroma ? BlockMap::Layers::kFieldAndColour : BlockMap::Layers::kFieldOnly;
    }
};

// The rasteriser if requested and available, else the ray caster. If it falls back, `note` says
// why.
std::unique_ptr<ViewPredictor> MakePredictor(IcpTracker::Prediction prediction, std::string& note);

// All methods for one camera, switchable between frames. They share the residual model. Owner
// thread only.
class Trackers {
  public:
    // `backend` outlives the trackers.
    Trackers(const TrackersConfig& config, const PinholeCamera& camera, Backend& backend);

    TrackingMethod method() const { return method_; }
    void Select(TrackingMethod method) { method_ = method; }
    // Takes effect at the next Track, with new trackers; what was learnt is kept.
    void Select(IcpTracker::Prediction prediction);
    // Whether the selected method reads the voxels of TrackInput::map on the CPU.
    bool reads_map() const;
    // Uses the selected method, which is created on first use, on the tracking thread.
    TrackResult Track(const TrackInput& input);
    // Overrides the configuration: alpha is estimated from the frames, or fixed to this value, in
    // m^2.
    void SetAlpha(bool automatic, double alpha) { model_.SetAlpha(automatic, alpha); }
    // Forgets what was learnt but keeps the settings.
    void Reset() { model_.Reset(); }
    // The learnt state.
    void SaveState(StateWriter& state) const { model_.SaveState(state); }
    bool LoadState(StateReader& state) { return model_.LoadState(state); }
    // A message for the user about how the methods were created. Returned once; usually empty.
    std::string TakeNote();
    // Time since the last call for uploading, drawing and reading back rasterised views; 0 if there
    // were none.
    double TakeRasterise_ms();

  private:
    std::unique_ptr<Tracker> Make(TrackingMethod method);

    TrackersConfig config_;
    PinholeCamera camera_;
    Backend& backend_;
    TrackingMethod method_;
    ResidualModel model_;
    std::array<std::unique_ptr<Tracker>, kTrackingMethods.size()> trackers_;
    std::vector<MeshRasteriser*> rasterisers_;  // owned by trackers_
    std::string note_;
};

}  // namespace tessera
