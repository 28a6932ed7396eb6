// The pipeline on one thread, frame by frame: track, then fuse. The threads of a live system
// (live_engine.h) run the same two stages.
#pragma once

#include <optional>

#include "system/mapping_stage.h"
#include "system/tracking_stage.h"

namespace tessera {

// Owner thread only.
class Pipeline {
  public:
    Pipeline(const PipelineConfig& config, const PinholeCamera& camera,
             const MeshConfig& meshing = {}, Backend* device = nullptr)
        : tracking_(config, camera, device), mapping_(config, meshing, camera, device) {}

    // With a given pose, the frame is fused there and not tracked. The world frame is the first
    // fused frame's camera unless its pose is given.
    FrameReport Process(const Frame& frame,
                        const std::optional<Eigen::Isometry3d>& given = std::nullopt) {
        tracking_.Track(frame, tracking_.reads_map() ? mapping_.map() : mapping_.blocks(), given,
                        tracked_);
        mapping_.Fuse(tracked_);
        return tracked_.report;
    }

    // Takes effect at the next frame. Pose, velocity, brightness and map are kept.
    void Select(TrackingMethod method) { tracking_.Select(method); }
    void SetFusing(bool on) { tracking_.SetFusing(on); }
    void Apply(const ViewerSettings& settings) { tracking_.Apply(settings); }
    void Reset() {
        tracking_.Reset();
        mapping_.Reset();
    }

    const BlockMap& map() const { return mapping_.map(); }
    TrackingStage& tracking() { return tracking_; }
    MappingStage& mapping() { return mapping_; }

  private:
    TrackingStage tracking_;
    MappingStage mapping_;
    TrackedFrame tracked_;
};

}  // namespace tessera
