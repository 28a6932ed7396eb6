// The camera never waits: reading, tracking and mapping on a thread each, over bounded lock-free queues; the newest frame
// wins and what is dropped is counted. docs/threads.md has every queue's capacity and policy.
#pragma once

#include <chrono>
#include <thread>

#include "core/pool.h"
#include "core/queue.h"
#include "io/selected_frames.h"
#include "mapping/map_delta.h"
#include "system/engine.h"
#include "system/engine_steps.h"
#include "system/resume_gate.h"
#include "system/run_control.h"
#include "system/scan_stage.h"
#include "system/viewer_feed.h"

namespace tessera {

class LiveEngine : public Engine {
  public:
    explicit LiveEngine(EngineInput input);
    ~LiveEngine() override;

    bool Next(FrameOutcome& outcome) override;
    const Status& status() const override { return status_; }
    bool stopped() const override { return stopped_; }
    TriangleMesh TakeMesh() override;
    const std::vector<MapObject>& objects() const override { return mapping_.objects(); }
    MapStatistics map_statistics() const override { return StatisticsOf(mapping_.map()); }

  private:
    using Clock = std::chrono::steady_clock;

    struct NewFrame {
        std::unique_ptr<Frame> frame;
        double decode_ms = 0;
        Clock::time_point arrival;
    };
    // A tracked frame, or a command where there is none.
    struct Task {
        std::unique_ptr<TrackedFrame> tracked;
        std::unique_ptr<Frame> frame;
        double decode_ms = 0, latency_ms = 0;
        ViewerCommand command;
    };
    // What a fused frame changed; `world` counts the resets before it.
    struct MapNews {
        std::unique_ptr<MapDelta> delta;
        int world = 0;
    };

    // A frame's life, a function a thread.
    void ReadFrames();
    void TrackFrames();
    void MapFrames();

    // Reading's.
    bool ReadFrame();
    void Obey(const ViewerCommand& command);
    void WaitUntilDue(double stamp_s);
    void Tell(FrameOutcome::Kind kind, const std::string& message);
    // Tracking's.
    void TrackFrame(NewFrame item, BlockMap& copy, TrackingStage& stage);
    void TakeMapNews(BlockMap& copy);
    void SaveTracking(const TrackingStage& stage, TrackedFrame& tracked) const;
    void Hand(Task task);
    // Mapping's.
    void MapFrame(Task& task);
    void SendMapNews();
    Status StartScan(ScanPlan plan);
    void Save(const Task& task, FrameOutcome& outcome);
    void OfferToLabelling(Task& task);
    void TakeLabels();
    void ObeyInMapping(const ViewerCommand& command);

    const RunConfig config_;
    FramePlan plan_;  // tracking's
    ViewerLink* const viewer_;
    const std::atomic<bool>& stop_;
    std::string record_path_;
    SelectedFrames frames_;        // reading's
    RunControl control_;           // reading's
    RecorderThread recorder_;      // reading's
    const SourceInfo source_;
    MappingStage mapping_;         // mapping's; the owner's once it has ended
    std::optional<ScanStage> scan_;  // mapping's; if it is to be saved
    ResumeGate gate_;              // tracking's
    Bytes saved_tracking_;         // tracking's, of a resumed scan
    std::optional<StampedPose> saved_pose_;  // the same
    ViewerFeed feed_;              // mapping's
    Status status_;                // reading's; the owner's once all have ended
    bool stopped_ = false;         // the same
    std::optional<double> first_stamp_s_;  // reading's
    Clock::time_point first_time_;
    int world_ = 0;                // tracking's
    int mapped_world_ = 0;         // mapping's

    Pool<Frame> frame_pool_;
    Pool<TrackedFrame> tracked_pool_;
    Pool<MapDelta> delta_pool_;
    static constexpr std::size_t kTasks = 8, kOutcomes = 4096;
    Wake tracking_wake_, mapping_wake_, outcome_wake_;
    std::optional<LabelReport> labels_;  // mapping's: for the next outcome
    NewestQueue<NewFrame> new_frames_;                           // reading to tracking
    FifoQueue<ViewerCommand> commands_{16, tracking_wake_};      // reading to tracking
    FifoQueue<Task> tasks_{kTasks, mapping_wake_};               // tracking to mapping
    FifoQueue<MapNews> map_news_{kTasks + 2, tracking_wake_};    // mapping to tracking
    NewestQueue<FrameOutcome> outcomes_{kOutcomes, outcome_wake_};  // reading and mapping to the owner
    std::unique_ptr<LabellingThread> labelling_;  // mapping's; null without labels
    std::atomic<bool> show_prediction_{true};
    std::atomic<bool> quit_{false}, reading_done_{false}, tracking_done_{false}, mapping_done_{false};
    std::jthread reading_thread_, tracking_thread_, mapping_thread_;
};

}  // namespace tessera
