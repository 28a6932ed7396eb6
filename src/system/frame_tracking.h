// The tracking half of a frame's life, the same in both modes (frame_mapping.h is the other half).
#pragma once

#include <optional>

#include "optimize/scan_parts.h"
#include "system/frame_plan.h"
#include "system/loss_watch.h"
#include "system/resume_gate.h"
#include "system/run_config.h"
#include "system/scan_plan.h"
#include "system/tracking_stage.h"

namespace tessera {

// Where tracking continues an earlier scan.
struct TrackingResume {
    Bytes state;  // TrackingStage::SaveState
    std::optional<StampedPose> last;
    double last_seen_s = 0;  // when the camera was tracked last
    bool lost = false;       // it was not tracked in the last frame
    bool only_localise = false;
    int parts = 0;  // places for parts that are taken already

    static TrackingResume Of(const ScanPlan& plan);
};

// The thread that tracks owns it.
class FrameTracking {
  public:
    FrameTracking(const RunConfig& config, const PinholeCamera& camera, Backend* device,
                  FramePlan plan)
        : plan_(std::move(plan)),
          stage_(config.pipeline, camera, device),
          gate_(config.pipeline.motion.max_gap_s),
          loops_(config.loops.enabled),
          may_part_(loops_ && config.EffectiveLoops().parts) {
        if (loops_) stage_.KeepImages();
    }

    // Call before the first frame.
    void Resume(const TrackingResume& resume) {
        parts_ = resume.parts;
        gate_.Begin(resume.state, resume.last, stage_);
        if (!resume.only_localise) return;
        stage_.OnlyTrack();
        may_part_ = false;
    }
    // Off: no new part of the scan begins.
    void SetSeeking(bool on) { seeking_ = on; }

    // A frame: first selects its method, which decides what map it needs, then tracks.
    void Begin(const Frame& frame) {
        plan_.Select(frame, stage_);
        if (watch_.anywhere() && may_part_ && seeking_ && stage_.fusing() && parts_ < kMostParts)
            BeginPart();
    }
    void Track(const Frame& frame, const BlockMap& map, TrackedFrame& tracked) {
        plan_.Track(frame, map, stage_, tracked);
        if (loops_ && !frame.colour.empty()) gate_.Open();  // it is found by appearance
        gate_.AfterTracking(frame, stage_, tracked);
        tracked.report.begins_part = parts_ > 0 && tracked.report.first;
        if (tracked.report.begins_part) tracked.report.warning = kPartBegins;
    }
    // When the frame's pose and status are final.
    void End(const TrackedFrame& tracked) { watch_.Add(tracked); }
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
        watch_.Clear();
        parts_ = 0;
    }
    TrackingStage& stage() { return stage_; }
    const TrackingStage& stage() const { return stage_; }

  private:
    void BeginPart();

    FramePlan plan_;
    TrackingStage stage_;
    ResumeGate gate_;
    LossWatch watch_;
    int parts_ = 0;  // begun after the first
    bool seeking_ = true;
    const bool loops_;
    bool may_part_;
};

}  // namespace tessera
