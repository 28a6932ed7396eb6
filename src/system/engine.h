// Drives frames through tracking and mapping: one after the other (lockstep_engine.h), or with each
// stage on its own thread while the camera keeps running (live_engine.h). The owner takes the
// outcomes in order.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "core/notices.h"
#include "core/status.h"
#include "io/frame_source.h"
#include "optimize/calibration_report.h"
#include "system/frame_plan.h"
#include "system/labelling_stage.h"
#include "system/mapping_stage.h"
#include "system/run_config.h"
#include "system/scan_plan.h"
#include "system/tracking_stage.h"
#include "system/viewer_link.h"

namespace tessera {

// The result of one frame, or another event that the run must handle.
struct FrameOutcome {
    enum class Kind {
        kFrame,        // `report` and all members after it are valid
        kSkipped,      // the frame could not be read; see `message`
        kDropped,      // live: a newer frame arrived before this one was tracked
        kMessage,      // text for the user
        kLabels,       // live: what was detected in an earlier frame; see `labels`
        kLabelsEnd,    // the detector failed; see `message`
        kLabelsBegin,  // another detector is in use; see `classes`
        kReset,        // the map and the trajectory start again
    };
    Kind kind = Kind::kFrame;
    std::string message;
    FrameReport report;
    std::optional<Eigen::Isometry3d> T_world_camera_truth;  // in the source's world frame
    // Live: tracked well, but not fused because mapping was busy.
    bool fusion_dropped = false;
    // Latency: from the frame's arrival to its pose.
    double decode_ms = 0, mesh_ms = 0, latency_ms = 0;
    double scan_ms = 0;  // building checkpoints, not writing them
    // Keyframes, loop closure and map correction. 0 without loop closure.
    double loops_ms = 0;
    MapStatistics map;
    std::shared_ptr<const LabelClasses> classes;  // of the run, with kLabelsBegin
    std::string detector;                         // its name, with kLabelsBegin
    std::optional<LabelReport> labels;  // lockstep: of this frame; live: with kLabels only
    std::vector<std::pair<const char*, std::size_t>> queues;  // queue name and length
};

struct EngineInput {
    std::unique_ptr<FrameSource> source;
    FrameSelection selection;
    RunConfig config;
    FramePlan plan;
    ScanPlan scan;                            // without a file, nothing is saved
    Labelling labelling;                      // without a detector, nothing is labelled
    OpenDetectorFunction open_detector = {};  // empty: no other detector can be chosen
    std::string record_path;                  // empty: no recording
    ViewerLink* viewer = nullptr;             // outlives the engine
    Backend* device = nullptr;                // null: CPU; outlives the engine
    const std::atomic<bool>* stop = nullptr;  // never null; outlives the engine
};

// Owner thread only.
class Engine {
  public:
    virtual ~Engine() = default;  // stops and joins the threads; allowed at any time

    // Waits for the next outcome. Returns false at the end: the source ended, a stop was requested,
    // or the source failed (see `status`).
    virtual bool Next(FrameOutcome& outcome) = 0;
    virtual const Status& status() const = 0;
    // Ends the run as the user's stop does: Next soon returns false.
    virtual void Stop() = 0;
    virtual bool stopped() const = 0;  // on request, before the source ended

    // Call once, after Next returned false. Releases the source and the map and returns the whole
    // mesh.
    virtual TriangleMesh TakeMesh() = 0;
    // Before TakeMesh: it is to keep the map, so that Save works. With a memory limit it may not.
    void KeepMap() { keep_map_ = true; }
    virtual bool has_map() const = 0;
    // After Next returned false, if the map is there: kSaveMesh and kSaveScan, as during the run.
    // Returns when the file is written.
    virtual void Save(const ViewerCommand& command) = 0;
    // Likewise: sends the window a part of the final mesh, as far as its queue has room. Returns
    // true when all of it was sent.
    virtual bool SendFinalMesh() = 0;
    // After TakeMesh; empty without labels.
    virtual const std::vector<MapObject>& objects() const = 0;
    virtual MapStatistics map_statistics() const = 0;  // before TakeMesh
    // After Next returned false: final poses of the tracked frames. Empty: the reported poses
    // stand.
    virtual std::vector<StampedPose> CorrectedPath() const { return {}; }
    // After Next returned false: the refined calibration. Nothing if refinement is off or there was
    // too little data for an estimate.
    virtual std::optional<CalibrationReport> calibration() const { return std::nullopt; }

    // Messages for the user that Next has not returned, for example of TakeMesh.
    std::optional<std::string> TakeNotice() { return notices_.Take(); }

  protected:
    bool keep_map_ = false;
    Wake outcome_wake_;  // Next sleeps here
    Notices notices_{outcome_wake_};
};

}  // namespace tessera
