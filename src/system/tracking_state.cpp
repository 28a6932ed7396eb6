// What tracking is told, saves and forgets.
#include "system/tracking_stage.h"

namespace tessera {

void TrackingStage::Apply(const ViewerSettings& settings) {
    if (settings.method_choices != method_choices_) trackers_.Select(settings.method);
    method_choices_ = settings.method_choices;
    trackers_.Select(settings.prediction);
    trackers_.SetAlpha(settings.auto_alpha, settings.alpha);
    config_.frame.max_depth_m = settings.max_depth_m;
    aligner_.Enable(settings.prealign);
    fusing_ = settings.fusing;
}

void TrackingStage::Reset() {
    BeginPart(Eigen::Isometry3d::Identity());
    usual_fit_.Clear();
    frozen_colour_.Clear();
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
