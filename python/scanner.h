// A scan driven frame by frame by the caller: the lockstep engine of `tessera run` with a source
// fed by the caller, so that the same frames give identical results.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "frame_feed.h"
#include "system/lockstep_engine.h"

namespace tessera::python {

// The result for one frame.
struct FrameResult {
    FrameReport report;
    double frame_ms = 0;                // the whole frame, including fusion and loop closure
    std::vector<std::string> messages;  // for the user; usually empty
};

// Thread-safe: calls are serialised. Throws std::invalid_argument for bad arguments,
// std::runtime_error for later failures and for calls in the wrong order. Does not touch Python.
class Scanner {
  public:
    // `labels`: a network or a detections file; empty: no labels.
    Scanner(const PinholeCamera& camera, const RunConfig& config, const std::string& labels);
    ~Scanner();
    Scanner(const Scanner&) = delete;
    Scanner& operator=(const Scanner&) = delete;

    const PinholeCamera& camera() const { return camera_; }

    // Tracks and fuses a frame. Images have the camera's size; colour may be empty. Stamps must
    // increase. Sets `index`.
    FrameResult Track(Frame frame);

    // Before Finish: poses as tracked. After Finish: corrected poses.
    std::vector<StampedPose> Path() const;
    // Before Finish: a snapshot of the map. After Finish: the final mesh, the same object each
    // time.
    std::shared_ptr<TriangleMesh> Mesh() const;

    // Call after the last frame: completes loop closure and builds the final mesh. Returns messages
    // for the user. Later calls do nothing.
    std::vector<std::string> Finish();
    // After Finish. Empty without labels.
    std::vector<MapObject> Objects() const;

  private:
    void Check(const Frame& frame) const;
    bool Next(FrameOutcome& outcome);

    const PinholeCamera camera_;
    mutable std::mutex mutex_;
    std::optional<tbb::global_control> thread_limit_;  // both only if run.threads is set
    mutable std::optional<tbb::task_arena> arena_;
    std::atomic<bool> stop_{false};
    std::shared_ptr<FrameFeed> feed_;
    std::unique_ptr<LockstepEngine> engine_;
    std::vector<StampedPose> path_;
    std::int64_t frames_ = 0;
    double last_stamp_s_ = 0;
    std::shared_ptr<TriangleMesh> final_mesh_;  // not null after Finish
};

}  // namespace tessera::python
