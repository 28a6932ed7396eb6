// Guards a resumed scan without loop closure, or of a camera without colour, which loop closure
// cannot find. If the first frame does not follow soon after the last one, the camera must be shown
// what it saw last. Until it is found there, all poses are rejected, so that nothing is fused in a
// wrong place.
#pragma once

#include "system/tracking_stage.h"

namespace tessera {

// The tracking stage's owner thread only.
class ResumeGate {
  public:
    explicit ResumeGate(double max_gap_s) : max_gap_s_(max_gap_s) {}

    // Call before the first frame. `saved` is a saved state of the tracking stage. If it is
    // invalid, or has no pose, the stage starts at the last pose; if that was corrected since, the
    // stage moves there. Without a last pose it starts a new world and the gate stays open.
    void Begin(std::span<const std::uint8_t> saved, const std::optional<StampedPose>& last,
               TrackingStage& tracking);
    // Opens the gate: a new world, or loop closure guards it.
    void Open() { closed_ = false; }
    // Call after tracking each frame.
    void AfterTracking(const Frame& frame, TrackingStage& tracking, TrackedFrame& tracked);

  private:
    bool IsThere(const TrackResult& track) const;

    double max_gap_s_;
    bool closed_ = false, first_ = false;
    double last_stamp_s_ = 0;
    Eigen::Isometry3d T_world_last_ = Eigen::Isometry3d::Identity();
};

}  // namespace tessera
