// The camera never waits: reading, tracking and mapping each run on their own thread, connected by
// bounded lock-free queues. The newest frame wins, and dropped frames are counted. With a device,
// one thread issues all its commands: the tracking thread also maps, and maps each frame before it
// tracks the next. docs/threads.md lists the capacity and policy of every queue.
#pragma once

#include <chrono>
#include <thread>

#include "core/pool.h"
#include "core/queue.h"
#include "io/selected_frames.h"
#include "mapping/map_delta.h"
#include "system/engine.h"
#include "system/engine_steps.h"
#include "system/loop_thread.h"
#include "system/lost_camera.h"
#include "system/paging_stage.h"
#include "system/resume_gate.h"
#include "system/run_control.h"
#include "system/scan_stage.h"
#include "system/viewer_feed.h"

namespace tessera {

// Simulates a slow source or a slow stage. No wait if `ms` <= 0.
void WaitFor(double ms);

class LiveEngine : public Engine {
  public:
    explicit LiveEngine(EngineInput input);
    ~LiveEngine() override;

    bool Next(FrameOutcome& outcome) override;
    const Status& status() const override { return status_; }
    bool stopped() const override { return stopped_; }
    TriangleMesh TakeMesh() override;
    const std::vector<MapObject>& objects() const override { return mapping_.objects(); }
    std::string mesh_warning() const override { return mapping_.mesh_warning(); }
    MapStatistics map_statistics() const override { return StatisticsOf(mapping_.blocks()); }
    std::vector<StampedPose> CorrectedPath() const override {
        return loops_ ? loops_->Path() : std::vector<StampedPose>();
    }
    std::optional<CalibrationReport> calibration() const override {
        return loops_ ? loops_->calibration() : std::nullopt;
    }

  private:
    using Clock = std::chrono::steady_clock;

    struct NewFrame {
        std::unique_ptr<Frame> frame;
        double decode_ms = 0;
        Clock::time_point arrival;
    };
    // A tracked frame, or a command if `tracked` is null.
    struct Task {
        std::unique_ptr<TrackedFrame> tracked;
        std::unique_ptr<Frame> frame;
        double decode_ms = 0, latency_ms = 0;
        int corrections = 0;  // number of corrections of the map it was tracked in
        // Pose at which a lost camera was relocalised, in that map.
        std::optional<Eigen::Isometry3d> T_found_camera;
        ViewerCommand command;
    };
    // The blocks that a fused frame changed, or the whole field of a corrected map. `world` is the
    // number of resets before it.
    struct MapUpdate {
        std::unique_ptr<MapDelta> delta;
        int world = 0;
        std::unique_ptr<BlockMap> field;
        Eigen::Isometry3d T_new_old = Eigen::Isometry3d::Identity();  // with `field`
    };
    // What a detector reports as movable, in a frame that was tracked in that map.
    struct Hint {
        MovingHint moving;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
        MapVersion map;
    };
    // State of the tracking thread.
    struct TrackingState {
        TrackingState(const RunConfig& config, const PinholeCamera& camera, Device* device)
            : stage(config.pipeline, camera, device),
              field(std::make_unique<BlockMap>(config.pipeline.map, BlockMap::Layers::kFieldOnly)),
              lost(config.loops, config.pipeline.motion.max_gap_s) {}

        TrackingStage stage;
        std::unique_ptr<BlockMap> field;  // copy of the map's field; unused with a device
        MapVersion version;               // of that copy
        LostCamera lost;
        bool asked = false;  // a relocalisation question is pending
    };

    void BeginLoops(std::optional<LoopCloser::Labels> labels);
    Status StartScan(ScanPlan plan);

    // One function per thread: live_engine.cpp, live_tracking.cpp, live_mapping.cpp.
    void ReadFrames();
    void TrackFrames();
    void MapFrames();

    // Reading thread.
    bool ReadFrame();
    void Execute(const ViewerCommand& command);
    void WaitUntilDue(double stamp_s);
    void Report(FrameOutcome::Kind kind, const std::string& message);
    // Tracking thread.
    void TrackFrame(NewFrame item, TrackingState& state);
    const BlockMap& MapToTrackIn(const TrackingState& state) const;
    void ApplyMapUpdates(TrackingState& state);
    void TakeHint(TrackingState& state);
    void ResetTracking(TrackingState& state);
    std::optional<Eigen::Isometry3d> TakeRelocalisation(double stamp_s, TrackingState& state);
    void CheckIfLost(TrackedFrame& tracked, TrackingState& state);
    void SaveTracking(const TrackingStage& stage, TrackedFrame& tracked) const;
    void SendTask(Task task);
    // Mapping thread.
    bool HasAnswers() const;
    bool MapNext();
    void EndMapping();
    void MapFrame(Task& task);
    void Page(Task& task, FrameOutcome& outcome);
    void SendMapUpdate();
    void Save(const Task& task, FrameOutcome& outcome);
    void Offer(Task& task);
    void TakeLabels();
    bool UpdateFits() const;
    void TakeLoops();
    void TakeUpdate(LoopThread::Update update, bool last);
    void EndLoops();
    void ReportLoopMessages();
    void ExecuteInMapping(const ViewerCommand& command);

    const RunConfig config_;
    // Null: CPU; with a device the tracking thread also owns all members marked "mapping".
    Device* const device_;
    FramePlan plan_;  // tracking
    ViewerLink* const viewer_;
    const std::atomic<bool>& stop_;
    std::string record_path_;
    SelectedFrames frames_;    // reading
    RunControl control_;       // reading
    RecorderThread recorder_;  // reading
    const SourceInfo source_;
    MappingStage mapping_;           // mapping; the owner's after mapping has ended
    std::optional<ScanStage> scan_;  // mapping; set if a scan is saved
    // Mapping, with a window: frames so far, in case the user starts saving a scan mid-run.
    std::vector<PathRecord> past_;
    std::atomic<bool> saving_{false};        // a scan is being saved: tracking saves its state
    std::unique_ptr<PagingStage> paging_;    // mapping; null without a memory limit
    ResumeGate gate_;                        // tracking
    Bytes saved_tracking_;                   // tracking; of a resumed scan
    std::optional<StampedPose> saved_pose_;  // tracking; of a resumed scan
    std::optional<double> saved_stamp_s_;    // tracking; of the resumed scan's last frame
    ViewerFeed feed_;                        // mapping
    Status status_;                          // reading; the owner's after all threads have ended
    bool stopped_ = false;                   // reading; the owner's after all threads have ended
    std::optional<double> first_stamp_s_;    // reading
    Clock::time_point first_time_;
    int mapped_world_ = 0;         // mapping
    double next_detection_s_ = 0;  // mapping
    // Mapping: T_new_old of each correction in this world.
    std::vector<Eigen::Isometry3d> corrections_;

    Pool<Frame> frame_pool_;
    Pool<TrackedFrame> tracked_pool_;
    Pool<MapDelta> delta_pool_;
    static constexpr std::size_t kTasks = 8, kCorrections = 3, kOutcomes = 4096;
    Wake tracking_wake_, own_mapping_wake_, outcome_wake_;
    Wake& mapping_wake_;
    std::optional<LabelReport> labels_;                      // mapping: for the next outcome
    NewestQueue<NewFrame> new_frames_;                       // reading to tracking
    FifoQueue<ViewerCommand> commands_{16, tracking_wake_};  // reading to tracking
    FifoQueue<Task> tasks_{kTasks, mapping_wake_};           // tracking to mapping
    FifoQueue<MapUpdate> map_updates_{kTasks + 2 + kCorrections,
                                      tracking_wake_};  // mapping to tracking
    NewestQueue<Hint> hints_{1, tracking_wake_};        // mapping to tracking
    // Reading, tracking and mapping to the owner.
    NewestQueue<FrameOutcome> outcomes_{kOutcomes, outcome_wake_};
    std::unique_ptr<LabellingThread> labelling_;  // mapping; null without labels
    // Mapping and tracking; null without loop closure.
    std::unique_ptr<LoopThread> loops_;
    std::atomic<bool> show_prediction_{true};
    std::atomic<bool> quit_{false}, reading_done_{false}, tracking_done_{false},
        mapping_done_{false};
    std::jthread reading_thread_, tracking_thread_, mapping_thread_;
};

}  // namespace tessera
