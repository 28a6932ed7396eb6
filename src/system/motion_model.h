// Where the camera is expected next: constant body velocity over the last two tracked frames, which
// comes to rest while frames are degenerate.
#pragma once

#include <optional>

#include "core/config.h"
#include "core/se3.h"
#include "core/state_stream.h"

namespace tessera {

// What is doubtful about a tracked pose.
struct PoseDoubt {
    // The scene left some motion unconstrained; what is not seen any more is taken to come to rest.
    bool degenerate = false;
    bool poor = false;         // the pose may be wrong
    double uncertainty_m = 0;  // TrackResult's
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

    // The last tracked pose; nothing before the first.
    const std::optional<StampedPose>& last() const { return last_; }
    const PoseDoubt& doubt() const { return doubt_; }  // of that pose
    // Seconds since then; 0 if there is none, or if it is too long ago to say anything about
    // velocity.
    double SinceLast(double stamp_s) const;
    // The pose expected at a time; the last pose, or identity, where there is nothing to go by.
    Eigen::Isometry3d Predict(double stamp_s) const;
    void Add(const StampedPose& pose, const PoseDoubt& doubt);
    void Clear();
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // The world was moved: the camera's velocity is its own and stays.
    void Move(const Eigen::Isometry3d& T_new_old) {
        if (last_) last_->T_world_camera = Normalised(T_new_old * last_->T_world_camera);
    }

  private:
    Config config_;
    std::optional<StampedPose> last_;
    std::optional<Vector6d> velocity_;  // body twist per second
    PoseDoubt doubt_;
};

}  // namespace tessera
