// Processes every frame. Each is tracked against the map of all earlier frames, so the output is
// identical on every run and for any number of threads. Only decoding runs ahead.
#pragma once

#include "io/frame_reader.h"
#include "system/engine.h"
#include "system/frame_labelling.h"
#include "system/frame_mapping.h"
#include "system/frame_tracking.h"
#include "system/loop_stage.h"
#include "system/recorder_thread.h"
#include "system/run_control.h"

namespace tessera {

class LockstepEngine : public Engine {
  public:
    explicit LockstepEngine(EngineInput input);

    bool Next(FrameOutcome& outcome) override;
    const Status& status() const override { return status_; }
    void Stop() override { stopped_ = true; }
    bool stopped() const override { return stopped_; }
    TriangleMesh TakeMesh() override;
    bool has_map() const override { return mapping_.stage().has_map(); }
    void Save(const ViewerCommand& command) override;
    bool SendFinalMesh() override { return mapping_.SendFinalMesh(); }
    const std::vector<MapObject>& objects() const override { return mapping_.stage().objects(); }
    std::vector<StampedPose> CorrectedPath() const override;
    std::optional<CalibrationReport> calibration() const override {
        return loops_ ? loops_->calibration() : std::nullopt;
    }
    MapStatistics map_statistics() const override {
        return StatisticsOf(mapping_.stage().blocks());
    }
    // The current map. Call between two calls of Next, before TakeMesh.
    const MappingStage& mapping() const { return mapping_.stage(); }

  private:
    Status StartScan(ScanPlan plan);
    void BeginLoops();

    void Process(FrameOutcome& outcome);
    void Label(FrameOutcome& outcome);
    void RelocaliseIfLost();
    void CloseLoops(FrameOutcome& outcome);

    bool TakeMessage(FrameOutcome& outcome);
    void Apply(const ViewerSettings& settings);
    void EnableLabels(const LabelClasses& classes);
    bool HandleViewer(FrameOutcome& outcome);
    bool Execute(const ViewerCommand& command, FrameOutcome& outcome);
    void Finish();

    const RunConfig config_;
    ViewerLink* const viewer_;
    const std::atomic<bool>& stop_;
    RunControl control_;
    const SourceInfo source_;
    FrameTracking tracking_;
    FrameMapping mapping_;
    std::optional<LoopStage> loops_;  // set if loop closure is on
    bool loops_on_ = true;            // the user may switch it off meanwhile
    std::optional<LoopCloser::Labels> loop_labels_;
    RecorderThread recorder_;
    FrameLabelling labelling_;
    std::unique_ptr<FrameReader> reader_;  // null after TakeMesh
    Frame frame_;
    TrackedFrame tracked_;
    Status status_;
    bool stopped_ = false, finished_ = false;
};

}  // namespace tessera
