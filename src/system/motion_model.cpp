#include "system/motion_model.h"

#include <cmath>

namespace tessera {

void MotionModel::Config::Describe(ConfigParameters& p) {
    p.Add("constant_velocity", constant_velocity,
          "start each frame at the pose predicted by constant velocity; off: at the last pose "
          "([B14], [D18])");
    p.Add("max_gap_s", max_gap_s, {0.0, 60.0}, "s",
          "the velocity is discarded if the gap between tracked frames is longer");
    p.Add("come_to_rest_s", come_to_rest_s, {0.0, 60.0}, "s",
          "in degenerate frames the velocity decays to 37 % within this time; otherwise unobserved "
          "motion would continue for ever");
}

double MotionModel::SinceLast(double stamp_s) const {
    if (!last_) return 0;
    const double gap_s = stamp_s - last_->stamp_s;
    return gap_s > 0 && gap_s <= config_.max_gap_s ? gap_s : 0;
}

Eigen::Isometry3d MotionModel::Predict(double stamp_s) const {
    if (!last_) return Eigen::Isometry3d::Identity();
    const double gap_s = SinceLast(stamp_s);
    if (!config_.constant_velocity || !velocity_ || gap_s == 0) return last_->T_world_camera;
    return last_->T_world_camera * Se3Exp(*velocity_ * gap_s);
}

void MotionModel::Add(const StampedPose& pose, const PoseDoubt& doubt) {
    const double gap_s = SinceLast(pose.stamp_s);
    if (gap_s > 0)
        velocity_ = Se3Log(last_->T_world_camera.inverse() * pose.T_world_camera) / gap_s;
    else
        velocity_.reset();
    if (doubt.degenerate && velocity_)
        *velocity_ *= config_.come_to_rest_s > 0 ? std::exp(-gap_s / config_.come_to_rest_s) : 0.0;
    last_ = pose;
    doubt_ = doubt;
    lost_frames_ = 0;
}

void MotionModel::Clear() {
    last_.reset();
    velocity_.reset();
    doubt_ = {};
    lost_frames_ = 0;
}

void MotionModel::SaveState(StateWriter& state) const {
    state.Put(last_.has_value());
    if (last_) {
        state.Put(last_->stamp_s);
        state.Put(last_->T_world_camera);
    }
    state.Put(velocity_);
    state.Put(doubt_.poor);
    state.Put(doubt_.uncertainty_m);
    state.Put(lost_frames_);
}

bool MotionModel::LoadState(StateReader& state) {
    bool has_last = false;
    if (!state.Get(has_last)) return false;
    if (has_last) {
        last_.emplace();
        if (!state.Get(last_->stamp_s) || !state.Get(last_->T_world_camera)) return false;
    }
    constexpr double kFastest_per_s = 1e3, kFarthest_m = 1e6;
    const bool read = state.Get(velocity_) && state.Get(doubt_.poor) &&
                      state.Get(doubt_.uncertainty_m) && state.Get(lost_frames_);
    return read && lost_frames_ >= 0 && lost_frames_ <= kMostLost &&
           (!velocity_ || velocity_->norm() <= kFastest_per_s) &&
           (!last_ || (std::isfinite(last_->stamp_s) &&
                       last_->T_world_camera.translation().norm() <= kFarthest_m)) &&
           std::isfinite(doubt_.uncertainty_m);
}

}  // namespace tessera
