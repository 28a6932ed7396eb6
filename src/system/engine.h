// How frames are driven through their life: one after the other (lockstep_engine.h), or each stage
// on a thread of its own while the camera goes on (live_engine.h). Whoever runs one takes what came
// of the frames, in order.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"
#include "io/frame_source.h"
#include "system/frame_plan.h"
#include "system/labelling_stage.h"
#include "system/run.h"
#include "system/scan_plan.h"
#include "system/tracking_stage.h"

namespace tessera {

// One frame's end, or what else a run must hear of.
struct FrameOutcome {
    enum class Kind {
        kFrame,      // `report` and all that follows it hold
        kSkipped,    // could not be read: `message`
        kDropped,    // live: a newer one came before it was tracked
        kMessage,    // for a person
        kLabelsEnd,  // the detector broke: `message`
        kReset,      // the map and the path begin anew
    };
    Kind kind = Kind::kFrame;
    std::string message;
    FrameReport report;
    std::optional<Eigen::Isometry3d> T_world_camera_truth;  // in the source's world
    // Live: well tracked, but mapping was busy.
    bool fusion_dropped = false;
    // Latency: from the frame's arrival to its pose.
    double decode_ms = 0, mesh_ms = 0, latency_ms = 0;
    double scan_ms = 0;  // making checkpoints, not writing them
    // Keyframes, loops, the corrected map; 0 without.
    double loops_ms = 0;
    MapStatistics map;
    std::optional<LabelReport> labels;  // of this frame, or live of an earlier one
    std::vector<std::pair<const char*, std::size_t>> queues;  // name and how many wait in it
};

struct EngineInput {
    std::unique_ptr<FrameSource> source;
    FrameSelection selection;
    RunConfig config;
    FramePlan plan;
    ScanPlan scan;                            // without a file nothing is saved
    Labelling labelling;                      // without a detector nothing is labelled
    std::string record_path;                  // empty = nothing is recorded
    ViewerLink* viewer = nullptr;             // outlives the engine
    Device* device = nullptr;                 // in the processor's place; outlives the engine
    const std::atomic<bool>* stop = nullptr;  // never null; outlives the engine
};

// Owner thread only.
class Engine {
  public:
    virtual ~Engine() = default;  // stops and joins, at any moment

    // Waits for the next outcome. False: no more, because the source ended, a stop was asked for,
    // or the source broke
    // (`status`).
    virtual bool Next(FrameOutcome& outcome) = 0;
    virtual const Status& status() const = 0;
    virtual bool stopped() const = 0;  // on request, before the source's end

    // After Next gave false, once: the source and the map go, the whole mesh comes.
    virtual TriangleMesh TakeMesh() = 0;
    virtual std::string mesh_warning() const { return {}; }  // after TakeMesh; mostly empty
    // After TakeMesh; empty without labels.
    virtual const std::vector<MapObject>& objects() const = 0;
    virtual MapStatistics map_statistics() const = 0;  // before TakeMesh
    // After Next gave false: the tracked frames' poses as they are known at the end; empty: as they
    // were given.
    virtual std::vector<StampedPose> CorrectedPath() const { return {}; }
    // The same of the calibration; nothing where it was not to be refined, or where too little was
    // seen for an estimate.
    virtual std::optional<CalibrationReport> calibration() const { return std::nullopt; }
};

}  // namespace tessera
