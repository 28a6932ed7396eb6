// Predicts the next camera pose: constant body velocity over the last two tracked frames, decaying
// to rest while frames are degenerate.
#pragma once

#include <algorithm>
#include <optional>

#include "core/config.h"
#include "core/se3.h"
#include "core/state_stream.h"

namespace tessera {

// What is doubtful about a tracked pose.
struct PoseDoubt {
    // The scene leaves some motion unconstrained. The velocity then decays to rest.
    bool degenerate = false;
    bool poor = false;         // the pose may be wrong
    double uncertainty_m = 0;  // as in TrackResult
};

class MotionModel {
  public:
    struct Config {
        bool constant_velocity = true;
        double max_gap_s = 0.5;
        double come_to_rest_s = 0.4;

        void Describe(ConfigParameters& parameters);
    };

    explicit MotionModel(const Config& config) : config_(config) {}

    // The last tracked pose. Nothing before the first.
    const std::optional<StampedPose>& last() const { return last_; }
    const PoseDoubt& doubt() const { return doubt_; }  // of that pose
    // Seconds since the last pose. 0 if there is none, or if the gap is too long to estimate a
    // velocity.
    double SinceLast(double stamp_s) const;
    // The predicted pose at a time. The last pose if no velocity is known, identity if there is no
    // pose.
    Eigen::Isometry3d Predict(double stamp_s) const;
    void Add(const StampedPose& pose, const PoseDoubt& doubt);
    // A frame without a pose.
    void AddLost() { lost_frames_ = std::min(lost_frames_ + 1, kMostLost); }
    // Since the last pose, at most a thousand.
    int lost_frames() const { return lost_frames_; }
    void Clear();
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // The world was moved. The velocity is in the body frame and does not change.
    void Move(const Eigen::Isometry3d& T_new_old) {
        if (last_) last_->T_world_camera = Normalised(T_new_old * last_->T_world_camera);
    }

  private:
    Config config_;
    std::optional<StampedPose> last_;
    std::optional<Vector6d> velocity_;  // body twist per second
    PoseDoubt doubt_;
    static constexpr int kMostLost = 1000;
    int lost_frames_ = 0;
};

}  // namespace tessera
