// Loop closure and relocalisation in the lockstep engine, between tracking and mapping. Owns the
// LoopCloser.
#pragma once

#include <functional>

#include "io/frame_source.h"
#include "optimize/loop_closer.h"
#include "system/camera_search.h"
#include "system/labelling_stage.h"
#include "system/loop_journal.h"
#include "system/tracking_stage.h"

namespace tessera {

// Settings of the small fields in which loops are verified: the same as the map's.
FieldSettings FieldSettingsOf(const PipelineConfig& pipeline, const PinholeCamera& camera);

// Owner thread only: the thread that tracks and fuses.
class LoopStage {
  public:
    // `make_pager`: see LoopCloser.
    LoopStage(const LoopConfig& config, const PipelineConfig& pipeline, const SourceInfo& source,
              std::optional<LoopCloser::Labels> labels, LoopCloser::MakePager make_pager);

    // Call before the first frame to continue an earlier run's loop closure. `last_seen_s`, `lost`:
    // see LostCamera.
    void Resume(LoopCloser::Memory memory, double last_seen_s, bool lost);

    // Off: neither closes loops nor looks for a lost camera.
    void Switch(bool on) {
        on_ = on;
        closer_.SetSeeking(on);
    }

    // Tries to relocalise a lost camera. After a loss, a pose is accepted only if it fits well or
    // if relocalisation confirms it. `bring` is called before the map around a candidate pose is
    // read.
    // A place found by appearance is checked with a second view before anything is fused.
    using LoadAround = std::function<void(const Eigen::Isometry3d& T_world_camera)>;
    void AfterTracking(const Frame& frame, const BlockMap& map, TrackingStage& tracking,
                       TrackedFrame& tracked, const LoadAround& bring);
    // Adds keyframes and closes loops. Calls `put` with the corrected map when it is ready. Returns
    // the time spent in ms, including AfterTracking.
    using PutMap = std::function<void(LoopCloser::Correction)>;
    double AfterFusion(const Frame& frame, TrackedFrame& tracked,
                       const std::optional<LabelReport>& labels, TrackingStage& tracking,
                       const PutMap& put);
    // Call once, after the last frame: completes all pending corrections. Returns a message for the
    // user, usually empty. `free_map`: see LoopCloser.
    std::string Finish(const PutMap& put, const std::function<void()>& free_map);

    void EnableLabels(LoopCloser::Labels labels) { closer_.EnableLabels(std::move(labels)); }
    std::vector<StampedPose> Path() const { return closer_.Path(); }
    const std::optional<CalibrationReport>& calibration() const { return closer_.calibration(); }
    // For a scan file.
    LoopChanges TakeChanges() {
        return finished_ ? journal_.Take(closer_, LoopJournal::kAllFrames) : journal_.Take(closer_);
    }
    // For another scan file, after Finish.
    LoopChanges TakeAll() {
        journal_ = LoopJournal();
        return TakeChanges();
    }

  private:
    bool Find(const Frame& frame, const BlockMap& map, const CameraSearch::Step& step,
              TrackingStage& tracking, TrackedFrame& tracked, const LoadAround& bring);
    void CheckPlace(TrackingStage& tracking, TrackedFrame& tracked);

    LoopConfig config_;
    CameraSearch search_;
    LoopCloser closer_;
    LoopJournal journal_;
    bool on_ = true, finished_ = false;
    double lost_ms_ = 0;  // of the current frame
};

}  // namespace tessera
