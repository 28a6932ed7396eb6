// What tracking is told, saves and forgets.
#include <fmt/format.h>

#include <utility>

#include "system/tracking_stage.h"

namespace tessera {

std::string TrackingStage::Apply(const ViewerSettings& settings) {
    if (settings.method_choices != method_choices_) trackers_.Select(settings.method);
    method_choices_ = settings.method_choices;
    trackers_.Select(settings.prediction);
    trackers_.SetAlpha(settings.auto_alpha, settings.alpha);
    const bool too_deep = config_.has_memory_limit() && settings.max_depth_m > planned_depth_m_;
    config_.frame.max_depth_m = too_deep ? planned_depth_m_ : settings.max_depth_m;
    aligner_.Enable(settings.prealign);
    fusing_ = settings.fusing;
    if (!too_deep || std::exchange(told_depth_, true)) return {};
    return fmt::format(
        "mapping.memory_limit_mb: the largest depth stays at {:.1f} m; to raise it, start with a "
        "larger frame.max_depth_m",
        planned_depth_m_);
}

void TrackingStage::Reset() {
    BeginPart(Eigen::Isometry3d::Identity());
    usual_fit_.Clear();
    frozen_colour_.Clear();
    colour_wrong_ = false;
}

void TrackingStage::BeginPart(const Eigen::Isometry3d& T_world_start) {
    T_world_start_ = T_world_start;
    motion_.Clear();
    moving_.Clear();
    aligner_.Clear();
    usual_fit_.ForgetPredictions();
    trackers_.Reset();
}

void TrackingStage::StartAt(const StampedPose& last) {
    Reset();
    motion_.Add(last, {});
}

void TrackingStage::SaveState(StateWriter& state) const {
    motion_.SaveState(state);
    aligner_.SaveState(state);
    trackers_.SaveState(state);
}

bool TrackingStage::LoadState(StateReader& state) {
    if (motion_.LoadState(state) && aligner_.LoadState(state) && trackers_.LoadState(state))
        return true;
    Reset();
    return false;
}

}  // namespace tessera
