// Processes every frame. Each is tracked against the map of all earlier frames, so the output is
// identical on every run and for any number of threads. Only decoding runs ahead.
#pragma once

#include "io/frame_reader.h"
#include "system/engine.h"
#include "system/engine_steps.h"
#include "system/loop_stage.h"
#include "system/paging_stage.h"
#include "system/resume_gate.h"
#include "system/run_control.h"
#include "system/scan_stage.h"
#include "system/viewer_feed.h"

namespace tessera {

class LockstepEngine : public Engine {
  public:
    explicit LockstepEngine(EngineInput input);

    bool Next(FrameOutcome& outcome) override;
    const Status& status() const override { return status_; }
    bool stopped() const override { return stopped_; }
    TriangleMesh TakeMesh() override;
    std::string mesh_warning() const override { return mapping_.mesh_warning(); }
    const std::vector<MapObject>& objects() const override { return mapping_.objects(); }
    std::vector<StampedPose> CorrectedPath() const override;
    std::optional<CalibrationReport> calibration() const override {
        return loops_ ? loops_->calibration() : std::nullopt;
    }
    MapStatistics map_statistics() const override { return StatisticsOf(mapping_.blocks()); }
    // The current map. Call between two calls of Next, before TakeMesh.
    const MappingStage& mapping() const { return mapping_; }

  private:
    // Waits while paused. Returns true if there is something to report.
    bool HandleViewer(FrameOutcome& outcome);
    bool Execute(const ViewerCommand& command, FrameOutcome& outcome);
    void BeginLoops();
    void PutMap(LoopCloser::Correction correction);
    bool TakeMessage(FrameOutcome& outcome);
    void Process(FrameOutcome& outcome);
    void Detect();
    void Label(FrameOutcome& outcome);
    Status StartScan(ScanPlan plan);
    void Save(FrameOutcome& outcome);

    RunConfig config_;
    FramePlan plan_;
    ViewerLink* viewer_;
    const std::atomic<bool>& stop_;
    RunControl control_;
    SourceInfo source_;
    TrackingStage tracking_;
    MappingStage mapping_;
    std::optional<LoopStage> loops_;  // set if loop closure is on
    std::optional<LoopCloser::Labels> loop_labels_;
    std::optional<ScanStage> scan_;  // set if a scan is saved
    std::string scan_path_;          // of a scan saved from the start; else empty
    std::vector<PathRecord> past_;   // with a window: in case the user starts saving a scan mid-run
    std::unique_ptr<PagingStage> paging_;  // null without a memory limit
    ResumeGate gate_;
    TrackedFrame tracked_;
    ViewerFeed feed_;
    RecorderThread recorder_;
    std::unique_ptr<LabellingStage> labelling_;  // null without labels
    std::optional<LabelReport> detected_;        // in the current frame
    std::string label_message_;
    std::optional<std::string> loops_message_;
    std::int64_t fused_frames_ = 0;
    std::unique_ptr<FrameReader> reader_;  // null after TakeMesh
    Frame frame_;
    Status status_;
    bool stopped_ = false;
};

}  // namespace tessera
