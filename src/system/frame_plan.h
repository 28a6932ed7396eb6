// Per-frame choices made before a run: poses to fuse at, and switches of the tracking method.
#pragma once

#include <string>
#include <vector>

#include "io/trajectory.h"
#include "system/tracking_stage.h"

namespace tessera {

// Takes effect at the first frame whose index is at least `frame`.
struct MethodSwitch {
    std::int64_t frame = 0;
    TrackingMethod method = TrackingMethod::kSdf;
};

// Owner thread only.
class FramePlan {
  public:
    FramePlan() = default;
    // `poses` empty: track. `poses_file` is used in messages only.
    FramePlan(std::vector<MethodSwitch> switches, std::vector<StampedPose> poses,
              const std::string& poses_file);

    // Selects the frame's tracking method. Call before Track and before TrackingStage::reads_map.
    void Select(const Frame& frame, TrackingStage& stage);
    // Calls TrackingStage::Track according to the plan. Frames must come in the source's order.
    void Track(const Frame& frame, const BlockMap& map, TrackingStage& stage,
               TrackedFrame& tracked);

  private:
    std::vector<MethodSwitch> switches_;  // sorted by frame
    std::size_t next_switch_ = 0;
    std::vector<StampedPose> poses_;
    std::string poses_file_;
};

}  // namespace tessera
