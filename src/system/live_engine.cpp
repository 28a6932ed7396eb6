#include "system/live_engine.h"

#include "core/check.h"
#include "core/stopwatch.h"
#include "system/loop_stage.h"

namespace tessera {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

}  // namespace

void WaitFor(double ms) {
    if (ms > 0) std::this_thread::sleep_for(Milliseconds(ms));
}

LiveEngine::LiveEngine(EngineInput input)
    : config_(input.config),
      device_(input.device),
      plan_(std::move(input.plan)),
      viewer_(input.viewer),
      stop_(*input.stop),
      frames_(std::move(input.source), input.selection),
      control_(input.viewer),
      recorder_(frames_.info(), config_.record, false),
      source_(frames_.info()),
      mapping_(config_.pipeline, config_.meshing, source_.camera, device_),
      gate_(config_.pipeline.motion.max_gap_s),
      feed_(input.viewer, config_.live.mesh_blocks),
      mapping_wake_(device_ != nullptr ? tracking_wake_ : own_mapping_wake_),
      new_frames_(static_cast<std::size_t>(config_.live.queue_frames), tracking_wake_) {
    if (!input.record_path.empty())
        status_ = StartRecording(input.record_path, config_.record, frames_.source(), recorder_);
    if (!status_.ok()) {
        mapping_done_.store(true);
        return;
    }
    if (device_ == nullptr) mapping_.KeepDeltas();
    std::optional<LoopCloser::Labels> labels;
    if (input.labelling.detector) {
        labels = LoopCloser::Labels{config_.labels, input.labelling.classes};
        mapping_.EnableLabels(config_.labels, input.labelling.classes);
        labelling_ = std::make_unique<LabellingThread>(
            LabellingStage(std::move(input.labelling.detector), std::move(input.labelling.classes),
                           config_.labels, source_.camera),
            mapping_wake_);
    }
    if (input.scan.file) status_ = StartScan(std::move(input.scan));
    if (!status_.ok()) {
        mapping_done_.store(true);
        return;
    }
    if (config_.loops.enabled) BeginLoops(std::move(labels));
    reading_thread_ = std::jthread([this] { ReadFrames(); });
    tracking_thread_ = std::jthread([this] { TrackFrames(); });
    if (device_ == nullptr) mapping_thread_ = std::jthread([this] { MapFrames(); });
}

void LiveEngine::BeginLoops(std::optional<LoopCloser::Labels> labels) {
    LoopThread::Settings settings{config_.loops,
                                  FieldSettingsOf(config_.pipeline, source_.camera),
                                  source_.depth_units_per_m,
                                  std::move(labels),
                                  scan_.has_value(),
                                  std::nullopt};
    if (scan_) {
        settings.resumed = scan_->TakeLoops();
        settings.make_pager = RebuildPagers(config_.pipeline, source_.camera, scan_->path());
    }
    loops_ = std::make_unique<LoopThread>(
        std::move(settings),
        LoopThread::Surroundings{frame_pool_, tracked_pool_, mapping_wake_, tracking_wake_});
}

// Call before the threads start: a resumed scan's map is the first map update for tracking.
Status LiveEngine::StartScan(ScanPlan plan) {
    if (plan.resumed) {
        saved_tracking_ = plan.resumed->tracking;
        saved_pose_ = plan.resumed->LastPose();
        saved_stamp_s_ = plan.resumed->progress.last_stamp_s;
    }
    scan_.emplace(std::move(plan), config_.scan, false, config_.loops.enabled);
    saving_.store(true);
    if (Status status = scan_->Resume(mapping_); !status.ok()) return status;
    if (Status status =
            StartPaging(config_.pipeline, source_.camera, scan_->path(), false, paging_);
        !status.ok())
        return status;
    if (device_ != nullptr || mapping_.map().size() == 1) return Status::Ok();
    MapUpdate whole{delta_pool_.Take(), 0, nullptr};
    mapping_.CollectWhole(*whole.delta);
    TESSERA_CHECK(map_updates_.TryPush(std::move(whole)),
                  "no room for the first update of the map");
    return Status::Ok();
}

LiveEngine::~LiveEngine() {
    quit_.store(true);
}  // reading ends first, then tracking, then mapping; each empties its queue

bool LiveEngine::Next(FrameOutcome& outcome) {
    bool got = false;
    outcome_wake_.Wait([&] { return (got = outcomes_.TryPop(outcome)) || mapping_done_.load(); });
    return got || outcomes_.TryPop(outcome);
}

TriangleMesh LiveEngine::TakeMesh() {
    TESSERA_CHECK(mapping_done_.load(), "TakeMesh was called before the end");
    return TakeFinalMesh(mapping_, scan_, paging_.get(), status_);
}

// ---- Reading: source -> newest frames.

void LiveEngine::ReadFrames() {
    while (!quit_.load() && !stopped_ && ReadFrame()) {
        while (const auto command = control_.TakeCommand()) Execute(*command);
        while (const auto message = recorder_.TakeMessage())
            Report(FrameOutcome::Kind::kMessage, *message);
        if (viewer_ != nullptr) viewer_->recording.store(recorder_.recording());
        stopped_ = stopped_ || stop_.load();
    }
    recorder_.Stop();
    while (const auto message = recorder_.TakeMessage())
        Report(FrameOutcome::Kind::kMessage, *message);
    reading_done_.store(true);
    tracking_wake_.Notify();
}

// Reads once from the source. Returns false at its end. While paused, a live camera's frames are
// read and discarded; a recording waits.
bool LiveEngine::ReadFrame() {
    if (control_.waiting() && !source_.live) {
        SleepBriefly();
        first_stamp_s_.reset();
        return true;
    }
    NewFrame item{frame_pool_.Take(), 0, {}};
    Stopwatch watch;
    const ReadResult read = frames_.Next(*item.frame);
    item.decode_ms = watch.LapMs();
    switch (read.status) {
        case ReadStatus::kError: status_ = Status::Error(read.message); return false;
        case ReadStatus::kEnd: return false;
        case ReadStatus::kSkip: Report(FrameOutcome::Kind::kSkipped, read.message); break;
        case ReadStatus::kWait:
            if (!read.message.empty()) Report(FrameOutcome::Kind::kMessage, read.message);
            break;
        case ReadStatus::kOk:
            if (!source_.live) WaitUntilDue(item.frame->stamp_s);
            if (!control_.TakeTurn()) break;
            recorder_.Add(*item.frame);
            item.arrival = Clock::now();
            if (auto dropped = new_frames_.Push(std::move(item))) {
                frame_pool_.Give(std::move(dropped->frame));
                Report(FrameOutcome::Kind::kDropped, {});
            }
            return true;
    }
    frame_pool_.Give(std::move(item.frame));
    return true;
}

// Waits until a recorded frame is as long after the first frame as it was recorded.
void LiveEngine::WaitUntilDue(double stamp_s) {
    constexpr double kAfterAll_s = 1.0;  // no waiting for longer gaps in the stamps
    const Clock::time_point now = Clock::now();
    if (first_stamp_s_) {
        const double wait_ms = 1000 * (stamp_s - *first_stamp_s_) / config_.live.playback_speed -
                               Milliseconds(now - first_time_).count();
        if (std::abs(wait_ms) < 1000 * kAfterAll_s) return WaitFor(wait_ms);
    }
    first_stamp_s_ = stamp_s;
    first_time_ = now;
}

void LiveEngine::Execute(const ViewerCommand& command) {
    switch (command.kind) {
        case ViewerCommand::Kind::kStop: stopped_ = true; break;
        case ViewerCommand::Kind::kRecord:
            if (Status status = recorder_.Start(command.path); !status.ok())
                Report(FrameOutcome::Kind::kMessage, status.message());
            break;
        case ViewerCommand::Kind::kStopRecording: recorder_.Stop(); break;
        default:
            if (!commands_.TryPush(ViewerCommand(command)))
                Report(FrameOutcome::Kind::kMessage, "too many commands at once: one was ignored");
    }
}

void LiveEngine::Report(FrameOutcome::Kind kind, const std::string& message) {
    FrameOutcome outcome;
    outcome.kind = kind;
    outcome.message = message;
    outcomes_.Push(std::move(outcome));
}

}  // namespace tessera
