// Loop closure and relocalisation between the two halves of a frame's life: the one place that
// knows both stages and the LoopCloser.
#pragma once

#include <functional>

#include "io/frame_source.h"
#include "optimize/loop_closer.h"
#include "system/labelling_stage.h"
#include "system/loop_journal.h"
#include "system/lost_camera.h"
#include "system/tracking_stage.h"

namespace tessera {

// How the small fields that loops are checked in are made: as the map itself.
FieldSettings FieldSettingsOf(const PipelineConfig& pipeline, const PinholeCamera& camera);

// Owner thread only: the one that tracks and fuses.
class LoopStage {
  public:
    // `make_pager` as LoopCloser's.
    LoopStage(const LoopConfig& config, const PipelineConfig& pipeline, const SourceInfo& source,
              std::optional<LoopCloser::Labels> labels, LoopCloser::MakePager make_pager);

    // Before the first frame: goes on with an earlier run's loops. Unless the first frame follows
    // soon after `last_stamp_s`, the camera counts as lost.
    void Resume(LoopCloser::Memory memory, double last_stamp_s);

    // A lost camera is looked for among the places it has seen. After a loss only a pose that fits
    // well, or that the place confirms, counts. `bring`: the map around a camera there is going to
    // be read.
    using BringAround = std::function<void(const Eigen::Isometry3d& T_world_camera)>;
    void AfterTracking(const Frame& frame, const BlockMap& map, TrackingStage& tracking,
                       TrackedFrame& tracked, const BringAround& bring);
    // Keyframes and loops; `put` takes the corrected map when it is ready. Returns the milliseconds
    // that it took, what AfterTracking took included.
    using PutMap = std::function<void(LoopCloser::Correction)>;
    double AfterFusion(const Frame& frame, TrackedFrame& tracked,
                       const std::optional<LabelReport>& labels, TrackingStage& tracking,
                       const PutMap& put);
    // No more frames: whatever is still to be corrected. Once. Returns what a person should know,
    // mostly empty.
    std::string Finish(const PutMap& put);

    std::vector<StampedPose> Path() const { return closer_.Path(); }
    const std::optional<CalibrationReport>& calibration() const { return closer_.calibration(); }
    // For a scan file.
    LoopNews TakeNews() {
        return finished_ ? journal_.Take(closer_, closer_.store().frames().size())
                         : journal_.Take(closer_);
    }

  private:
    LoopConfig config_;
    LostCamera camera_;
    LoopCloser closer_;
    LoopJournal journal_;
    bool finished_ = false;
    double lost_ms_ = 0;  // of the present frame
};

}  // namespace tessera
