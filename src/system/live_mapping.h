// The mapping thread of a live run: takes tracked frames and commands; updates the map, the meshes
// and tracking's copy of the map; sends outcomes.
#pragma once

#include "core/worker.h"
#include "mapping/map_copier.h"
#include "system/frame_mapping.h"
#include "system/live_links.h"
#include "system/loop_thread.h"

namespace tessera {

// With a device, one thread issues all its commands: the functions of the mapping thread then run
// on the tracking thread, which maps each frame before it tracks the next.
class LiveMapping {
  public:
    // `links` and the others outlive the object.
    LiveMapping(const RunConfig& config, const SourceInfo& source, Backend* device,
                ViewerLink* viewer, LiveLinks& links);

    // Prepares labels, the scan and loop closure, then starts the thread.
    Status Start(Labelling labelling, OpenDetectorFunction open_detector, ScanPlan plan);

    // ---- Tracking thread.
    // Call once: its copy of a resumed scan's map. Null for a new one, or with a device.
    std::unique_ptr<BlockMap> TakeField() { return std::move(field_); }
    // Waits if mapping is far behind. It then skips fusion until it has caught up.
    void Send(MappingTask task);
    // With a device: takes what other threads have answered.
    bool HasAnswersToTake() const { return !worker_ && HasAnswers(); }
    void TakeAnswersHere() {
        if (!worker_) TakeAnswers();
    }
    // Call after the last task: maps what waits, closes pending loops and completes the scan file.
    void Finish();
    LoopThread* loops() const { return loops_.get(); }  // null without loop closure
    // With a device: the map to track in.
    const BlockMap& MapFor(const TrackingStage& tracking) const { return life_.MapFor(tracking); }

    // ---- The owner, after the end.
    void Save(const ViewerCommand& command);
    FrameMapping& life() { return life_; }
    const FrameMapping& life() const { return life_; }

  private:
    void StartLabels(Labelling labelling);
    void ChangeDetector(const std::string& name);
    void StartLoops(std::optional<LoopCloser::Labels> labels,
                    std::optional<LoopCloser::Memory> resumed);

    bool HasAnswers() const;
    void TakeAnswers();
    void Process(MappingTask& task);
    void MapFrame(MappingTask& task);
    void SendMapUpdate(bool first);
    bool DetectionDue(double stamp_s) const;
    void Offer(MappingTask& task);
    void TakeLabels();
    void TakeLabels(LabellingThread::Answer& answer);
    void TakeDetector(DetectorChange& change);
    bool UpdateFits() const;
    void TakeLoops();
    void CopyMap();
    void TakeUpdate(LoopThread::Update update, bool last);
    void Execute(const ViewerCommand& command);
    void Reset();
    void End();
    MapVersion version() const { return {world_, static_cast<int>(corrections_.size())}; }

    const RunConfig config_;
    const SourceInfo source_;
    const bool one_thread_;
    LiveLinks& links_;
    FrameMapping life_;
    int world_ = 0;                               // number of resets
    std::vector<Eigen::Isometry3d> corrections_;  // T_new_old of each correction in this world
    std::unique_ptr<BlockMap> field_;             // of a resumed scan, until tracking takes it
    std::optional<double> last_detection_s_;      // stamp of the last frame offered to labelling
    std::unique_ptr<LabellingThread> labelling_;  // null without labels
    OpenDetectorFunction open_detector_;
    MapCopier copier_;                           // for loop closure
    std::unique_ptr<LoopThread> loops_;          // null without loop closure
    std::optional<Worker<MappingTask>> worker_;  // none with a device
};

}  // namespace tessera
