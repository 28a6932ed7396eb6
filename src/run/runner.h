// One run in progress: opens the inputs, takes the engine's outcomes, keeps the counts and writes
// the files. run.h is the public interface.
#pragma once

#include <set>

#include "core/process.h"
#include "core/stopwatch.h"
#include "run/memory_watch.h"
#include "run/run.h"
#include "run/run_output.h"
#include "run/source_camera.h"
#include "system/engine.h"

namespace tessera {

// Owner thread only; runs once. All arguments outlive it.
class Runner {
  public:
    Runner(const RunRequest& request, const RunConfig& config, const RunObserver& observer)
        : request_(request),
          config_(config),
          observer_(observer),
          selection_(request.selection),
          memory_(config) {}

    Result<RunSummary> Run(const std::atomic<bool>& stop);

  private:
    Status Open(const std::atomic<bool>& stop);
    // What was found out about the camera before the first frame.
    void TakeCamera(const CheckedSource& checked);
    void BeginShutters(PipelineConfig& config);
    Result<ScanPlan> OpenScan();
    // Called at the first outcome, not before: a run that is refused, or that is stopped before its
    // first frame, leaves the results of an earlier run.
    Status Begin();
    Status BeginWithoutFrames();
    void TellOpened();

    Status TakeOutcomes();
    Status Take(const FrameOutcome& outcome);
    void TakeFrame(const FrameOutcome& outcome);
    void TakeLabels(const LabelReport& report);
    // Another detector is in use, or the first.
    Status BeginLabels(const LabelClasses& classes, const std::string& detector);
    void EndLabels(const std::string& why);
    // To the window. The map's owner sends meshes and images (viewer_feed.h).
    void Show(const FrameOutcome& outcome);
    void ShowLabels(const LabelReport& report);
    void AddTimes(const FrameOutcome& outcome, double frame_ms);
    // After a reset, the output files also cover only the new world.
    Status BeginAnew();
    Status OpenOutput();
    // A run goes on without the lines that find no room on the disk. Said once per file.
    void KeepGoing(const Status& written);
    void Skip(const std::string& message);
    void Count(const FrameOutcome& outcome);
    // Warns only when the tracking status changes, not for every lost frame.
    void WarnOnStatusChange(const FrameReport& report);

    Status Finish(const Status& outcome);
    // While a window is open, it gets the final mesh, and what the ended run holds can be saved.
    void ServeWindow(const std::atomic<bool>& stop);
    Result<AteResult> Evaluate() const;
    // Frames of this run that the final path does not have count as lost.
    void CountLeftOut(const std::vector<StampedPose>& path);
    // Takes over the final poses and the refined calibration.
    Status Correct();
    Status WriteMesh();
    std::int64_t Total() const;
    void Warn(const std::string& text);

    const RunRequest& request_;
    RunConfig config_;  // with the band that fits the camera
    const RunObserver& observer_;
    // Frames still to read: fewer than requested if a scan is resumed.
    FrameSelection selection_;
    std::int64_t frames_before_ = 0;  // frames in the resumed scan
    MemoryWatch memory_;
    std::vector<StampedPose> truth_, estimate_;
    std::vector<std::pair<double, bool>> tracked_;  // stamps of this run's tracked frames; fused?
    std::optional<Eigen::Isometry3d> T_map_truth_;  // from its first one that has ground truth
    std::vector<std::string> notes_;                // from opening, for the user
    LabelClasses class_names_;
    std::unique_ptr<Engine> engine_;
    std::unique_ptr<RunOutput> output_;
    StageTimes times_;
    Stopwatch frame_watch_;
    RunSummary summary_;
    struct Told {
        TrackStatus status = TrackStatus::kGood;
        bool degenerate = false, colour_rejected = false;
        std::set<std::string> errors;  // from writing
    } told_;
    bool begun_ = false, opened_ = false;  // opened_: the observer knows
};

}  // namespace tessera
