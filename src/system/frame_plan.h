// What was decided before a run about single frames: poses to fuse at, and switches of method.
#pragma once

#include <string>
#include <vector>

#include "io/trajectory.h"
#include "system/run.h"
#include "system/tracking_stage.h"

namespace tessera {

// Owner thread only.
class FramePlan {
  public:
    FramePlan() = default;
    // `poses` empty: track. `poses_file` is for messages.
    FramePlan(std::vector<MethodSwitch> switches, std::vector<StampedPose> poses,
              const std::string& poses_file);

    // Selects the frame's method; before Track, and before anybody asks whether that method reads
    // the map.
    void Select(const Frame& frame, TrackingStage& stage);
    // TrackingStage::Track by the plan. Frames are to come in the source's order.
    void Track(const Frame& frame, const BlockMap& map, TrackingStage& stage,
               TrackedFrame& tracked);

  private:
    std::vector<MethodSwitch> switches_;  // by frame
    std::size_t next_switch_ = 0;
    std::vector<StampedPose> poses_;
    std::string poses_file_;
};

}  // namespace tessera
