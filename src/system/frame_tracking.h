// The tracking half of a frame's life, the same in both modes (frame_mapping.h is the other half).
#pragma once

#include <optional>

#include "system/frame_plan.h"
#include "system/resume_gate.h"
#include "system/run_config.h"
#include "system/scan_plan.h"
#include "system/start_watch.h"
#include "system/tracking_stage.h"

namespace tessera {

// Where tracking continues an earlier scan.
struct TrackingResume {
    Bytes state;  // TrackingStage::SaveState
    std::optional<StampedPose> last;
    double last_stamp_s = 0;
    bool only_localise = false;

    static TrackingResume Of(const ScanPlan& plan) {
        const ScanContent& scan = *plan.resumed;
        return {scan.tracking, scan.LastPose(), scan.progress.last_stamp_s, plan.only_localise()};
    }
};

// The thread that tracks owns it.
class FrameTracking {
  public:
    FrameTracking(const RunConfig& config, const PinholeCamera& camera, Backend* device,
                  FramePlan plan)
        : plan_(std::move(plan)),
          stage_(config.pipeline, camera, device),
          gate_(config.pipeline.motion.max_gap_s),
          loops_(config.loops.enabled) {
        if (loops_) stage_.KeepImages();
    }

    // Call before the first frame.
    void Resume(const TrackingResume& resume) {
        resumed_ = true;
        gate_.Begin(resume.state, resume.last, !loops_, stage_);
        if (resume.only_localise) stage_.OnlyTrack();
    }

    // A frame: first selects its method, which decides what map it needs, then tracks.
    void Begin(const Frame& frame) { plan_.Select(frame, stage_); }
    void Track(const Frame& frame, const BlockMap& map, TrackedFrame& tracked) {
        plan_.Track(frame, map, stage_, tracked);
        gate_.AfterTracking(frame, stage_, tracked);
    }
    // When the frame's pose and status are final.
    void End(const TrackedFrame& tracked) {
        if (!resumed_) start_.Add(tracked);
    }
    // The scan is to begin again with the next frame.
    bool start_failed() const { return start_.failed(); }
    // For a scan file: the state travels with its frame, so that a checkpoint after that frame
    // contains it.
    void SaveState(TrackedFrame& tracked) const {
        tracked.tracking_state.clear();
        StateWriter state(tracked.tracking_state);
        stage_.SaveState(state);
    }

    // Starts a new world.
    void Reset() {
        stage_.Reset();
        gate_.Open();
        start_.Clear();
        resumed_ = false;
    }
    TrackingStage& stage() { return stage_; }
    const TrackingStage& stage() const { return stage_; }

  private:
    FramePlan plan_;
    TrackingStage stage_;
    ResumeGate gate_;
    StartWatch start_;
    bool resumed_ = false;
    const bool loops_;
};

}  // namespace tessera
