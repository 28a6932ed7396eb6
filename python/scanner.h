// A scan that is driven frame by frame by whoever has the images: the lockstep engine of `tessera
// run` behind a source that is fed by hand, so that the same frames give the same bytes.
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

// What became of a frame that was handed in.
struct FrameResult {
    FrameReport report;
    double frame_ms = 0;                // the whole frame, fused and with loops
    std::vector<std::string> messages;  // for a person; mostly empty
};

// Thread-safe: calls wait for one another. Throws std::invalid_argument for what the caller gave,
// std::runtime_error for what broke and for calls that come too early or too late. Nothing here
// touches Python.
class Scanner {
  public:
    // `labels`: a network or a file of detections; empty = no labels.
    Scanner(const PinholeCamera& camera, const RunConfig& config, const std::string& labels);
    ~Scanner();
    Scanner(const Scanner&) = delete;
    Scanner& operator=(const Scanner&) = delete;

    const PinholeCamera& camera() const { return camera_; }

    // Tracks and fuses. Images are of the camera's size, or colour is empty; stamps grow. `index`
    // is set here.
    FrameResult Track(Frame frame);

    // As far as it is known: before Finish as the frames were tracked, after it as they were
    // corrected.
    std::vector<StampedPose> Path() const;
    // A snapshot of the map before Finish; after it the final mesh, the same object each time.
    std::shared_ptr<TriangleMesh> Mesh() const;

    // No more frames: loops are corrected, the map becomes the mesh. Returns messages for a person.
    // Once or more.
    std::vector<std::string> Finish();
    // After Finish; empty without labels.
    std::vector<MapObject> Objects() const;

  private:
    void Check(const Frame& frame) const;
    bool Next(FrameOutcome& outcome);

    const PinholeCamera camera_;
    mutable std::mutex mutex_;
    std::optional<tbb::global_control> thread_limit_;  // both with run.threads only
    mutable std::optional<tbb::task_arena> arena_;
    std::atomic<bool> stop_{false};
    std::shared_ptr<FrameFeed> feed_;
    std::unique_ptr<LockstepEngine> engine_;
    std::vector<StampedPose> path_;
    std::int64_t frames_ = 0;
    double last_stamp_s_ = 0;
    std::shared_ptr<TriangleMesh> final_mesh_;  // not null: finished
};

}  // namespace tessera::python
