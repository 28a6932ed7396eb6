#include "system/tracking_method.h"

#include <utility>

#include "mapping/ray_caster.h"

namespace tessera {

const char* ToString(TrackingMethod method) { return InfoOf(method).name; }

std::vector<std::string> TrackingMethodNames() {
    std::vector<std::string> names;
    for (const TrackingMethodInfo& info : kTrackingMethods) names.emplace_back(info.name);
    return names;
}

std::optional<TrackingMethod> TrackingMethodOf(std::string_view name) {
    for (const TrackingMethodInfo& info : kTrackingMethods)
        if (name == info.name) return info.method;
    return std::nullopt;
}

void TrackersConfig::Describe(ConfigParameters& p) {
    std::vector<std::pair<std::string, TrackingMethod>> methods;
    for (const TrackingMethodInfo& info : kTrackingMethods)
        methods.emplace_back(info.name, info.method);
    p.AddChoice(
        "method", method, methods,
        "sdf aligns with distances and intensities in the field ([B14]); sdf-geometric with "
        "distances only ([B13]); icp with a predicted view ([D18]); icp-rgb also with its colours");
    p.Add("even_within_m", even_within_m, {0.0, 1.0}, "m",
          "if the uncertainty of the last pose is at most this, points nearer than the view's "
          "median depth weigh no more than points at that depth, so that nearby moving things do "
          "not outweigh the room");
    p.Section("judge", [&](ConfigParameters& s) { judge.Describe(s); });
    p.Section("photometric", [&](ConfigParameters& s) { photometric.Describe(s); });
    p.Section("sdf", [&](ConfigParameters& s) { sdf.Describe(s); });
    p.Section("icp", [&](ConfigParameters& s) { icp.Describe(s); });
}

Trackers::Trackers(const TrackersConfig& config, const PinholeCamera& camera, Backend& backend)
    : config_(config),
      camera_(camera),
      backend_(backend),
      method_(config.method),
      model_(config.photometric) {}

void Trackers::Select(IcpTracker::Prediction prediction) {
    if (std::exchange(config_.icp.prediction, prediction) == prediction) return;
    rasterisers_.clear();
    for (const TrackingMethod method : {TrackingMethod::kIcp, TrackingMethod::kIcpRgb})
        trackers_[static_cast<std::size_t>(method)].reset();
}

bool Trackers::reads_map() const {
    const bool icp = method_ == TrackingMethod::kIcp || method_ == TrackingMethod::kIcpRgb;
    return !backend_.on_device() ||
           (icp && config_.icp.prediction == IcpTracker::Prediction::kRaster);
}

TrackResult Trackers::Track(const TrackInput& input) {
    std::unique_ptr<Tracker>& tracker = trackers_[static_cast<std::size_t>(method_)];
    if (!tracker) tracker = Make(method_);
    return tracker->Track(input);
}

std::unique_ptr<ViewPredictor> MakePredictor(IcpTracker::Prediction prediction, std::string& note) {
    if (prediction == IcpTracker::Prediction::kRaster) {
        Result<std::unique_ptr<MeshRasteriser>> rasteriser = MeshRasteriser::Create(MeshConfig());
        if (rasteriser.ok()) return std::move(rasteriser.value());
        note = "predicting by ray casting: " + rasteriser.status().message();
    }
    return std::make_unique<RayCaster>();
}

std::unique_ptr<Tracker> Trackers::Make(TrackingMethod method) {
    const TrackJudge judge(config_.judge);
    const bool colour = InfoOf(method).colour;
    switch (method) {
        case TrackingMethod::kSdf:
        case TrackingMethod::kSdfGeometric:
            return std::make_unique<SdfTracker>(config_.sdf, camera_, judge, model_, colour,
                                                &backend_.sdf_sums());
        case TrackingMethod::kIcp:
        case TrackingMethod::kIcpRgb: break;
    }
    std::unique_ptr<ViewPredictor> predictor;  // none: the backend casts the rays
    if (config_.icp.prediction == IcpTracker::Prediction::kRaster)
        predictor = MakePredictor(config_.icp.prediction, note_);
    if (auto* rasteriser = dynamic_cast<MeshRasteriser*>(predictor.get()))
        rasterisers_.push_back(rasteriser);
    return std::make_unique<IcpTracker>(config_.icp, camera_, judge, model_, colour,
                                        std::move(predictor), &backend_.icp_sums());
}

std::string Trackers::TakeNote() { return std::exchange(note_, {}); }

double Trackers::TakeRasterise_ms() {
    double sum_ms = 0;
    for (MeshRasteriser* rasteriser : rasterisers_) {
        const MeshRasteriser::Timings timings = rasteriser->TakeTimings();
        sum_ms += timings.upload_ms + timings.draw_ms + timings.read_back_ms;
    }
    return sum_ms;
}

}  // namespace tessera
