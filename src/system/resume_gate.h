// A resumed scan without loop closure: where the camera does not follow at once on the last frame
// it has to be shown what it saw last, and until it is found there nothing is believed, so that
// nothing is fused in a wrong place.
#pragma once

#include "system/tracking_stage.h"

namespace tessera {

// The tracking stage's owner thread only.
class ResumeGate {
  public:
    explicit ResumeGate(double max_gap_s) : max_gap_s_(max_gap_s) {}

    // The next frame is the first after one at that time. `tracking` is a saved state of the
    // tracking stage; where it is none, the stage starts at the last pose. Without a last pose it
    // starts a new world, and there is no gate.
    void Begin(std::span<const std::uint8_t> saved, const std::optional<StampedPose>& last,
               bool gated, TrackingStage& tracking);
    // A new world: there is no gate.
    void Open() { closed_ = false; }
    // After each frame's tracking.
    void AfterTracking(const Frame& frame, TrackingStage& tracking, TrackedFrame& tracked);

  private:
    bool IsThere(const TrackResult& track) const;

    double max_gap_s_;
    bool closed_ = false, first_ = false;
    double last_stamp_s_ = 0;
    Eigen::Isometry3d T_world_last_ = Eigen::Isometry3d::Identity();
};

}  // namespace tessera
