#include "system/live_engine.h"

#include "core/check.h"
#include "core/stopwatch.h"

namespace tessera {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

void Dawdle(double ms) {
    if (ms > 0) std::this_thread::sleep_for(Milliseconds(ms));
}

}  // namespace

LiveEngine::LiveEngine(EngineInput input)
    : config_(input.config),
      plan_(std::move(input.plan)),
      viewer_(input.viewer),
      stop_(*input.stop),
      frames_(std::move(input.source), input.selection),
      control_(input.viewer),
      recorder_(frames_.info(), config_.record, false),
      source_(frames_.info()),
      mapping_(config_.pipeline, config_.meshing, source_.camera),
      gate_(config_.pipeline.motion.max_gap_s),
      feed_(input.viewer, config_.live.mesh_blocks),
      new_frames_(static_cast<std::size_t>(config_.live.queue_frames), tracking_wake_) {
    if (!input.record_path.empty()) status_ = StartRecording(input.record_path, config_.record, frames_.source(), recorder_);
    if (!status_.ok()) {
        mapping_done_.store(true);
        return;
    }
    if (input.labelling.detector) {
        mapping_.EnableLabels(config_.labels, input.labelling.classes);
        labelling_ = std::make_unique<LabellingThread>(LabellingStage(std::move(input.labelling.detector),
                                                                      std::move(input.labelling.classes), config_.labels),
                                                       mapping_wake_);
    }
    if (input.scan.file) status_ = StartScan(std::move(input.scan));
    if (!status_.ok()) {
        mapping_done_.store(true);
        return;
    }
    reading_thread_ = std::jthread([this] { ReadFrames(); });
    tracking_thread_ = std::jthread([this] { TrackFrames(); });
    mapping_thread_ = std::jthread([this] { MapFrames(); });
}

// Before the threads: a resumed scan's map is the first news of the map.
Status LiveEngine::StartScan(ScanPlan plan) {
    if (plan.resumed) {
        saved_tracking_ = plan.resumed->tracking;
        saved_pose_ = plan.resumed->LastPose();
    }
    scan_.emplace(std::move(plan), config_.scan, false);
    if (Status status = scan_->Resume(mapping_, nullptr); !status.ok()) return status;
    if (mapping_.map().size() == 1) return Status::Ok();
    MapNews whole{delta_pool_.Take(), 0};
    mapping_.CollectWhole(*whole.delta);
    TESSERA_CHECK(map_news_.TryPush(std::move(whole)), "no room for the first news of the map");
    return Status::Ok();
}

LiveEngine::~LiveEngine() { quit_.store(true); }  // reading ends, then tracking, then mapping: each empties its queue

bool LiveEngine::Next(FrameOutcome& outcome) {
    bool got = false;
    outcome_wake_.Wait([&] { return (got = outcomes_.TryPop(outcome)) || mapping_done_.load(); });
    return got || outcomes_.TryPop(outcome);
}

TriangleMesh LiveEngine::TakeMesh() {
    TESSERA_CHECK(mapping_done_.load(), "the mesh is taken before the end");
    return mapping_.TakeMesh();
}

// ---- Reading: source -> newest frames.

void LiveEngine::ReadFrames() {
    while (!quit_.load() && !stopped_ && ReadFrame()) {
        while (const auto command = control_.TakeCommand()) Obey(*command);
        while (const auto message = recorder_.TakeMessage()) Tell(FrameOutcome::Kind::kMessage, *message);
        if (viewer_ != nullptr) viewer_->recording.store(recorder_.recording());
        stopped_ = stopped_ || stop_.load();
    }
    recorder_.Stop();
    while (const auto message = recorder_.TakeMessage()) Tell(FrameOutcome::Kind::kMessage, *message);
    reading_done_.store(true);
    tracking_wake_.Notify();
}

// One look at the source; false at its end. A paused camera's frames are read and let go, a recording waits.
bool LiveEngine::ReadFrame() {
    if (control_.waiting() && !source_.live) {
        PauseBriefly();
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
        case ReadStatus::kSkip: Tell(FrameOutcome::Kind::kSkipped, read.message); break;
        case ReadStatus::kWait:
            if (!read.message.empty()) Tell(FrameOutcome::Kind::kMessage, read.message);
            break;
        case ReadStatus::kOk:
            if (!source_.live) WaitUntilDue(item.frame->stamp_s);
            if (!control_.TakeTurn()) break;
            recorder_.Add(*item.frame);
            item.arrival = Clock::now();
            if (auto dropped = new_frames_.Push(std::move(item))) {
                frame_pool_.Give(std::move(dropped->frame));
                Tell(FrameOutcome::Kind::kDropped, {});
            }
            return true;
    }
    frame_pool_.Give(std::move(item.frame));
    return true;
}

// A recorded frame's time comes as long after the first frame's as it was recorded.
void LiveEngine::WaitUntilDue(double stamp_s) {
    constexpr double kAfterAll_s = 1.0;  // a longer gap in the stamps is not waited for
    const Clock::time_point now = Clock::now();
    if (first_stamp_s_) {
        const double wait_ms = 1000 * (stamp_s - *first_stamp_s_) / config_.live.playback_speed -
                               Milliseconds(now - first_time_).count();
        if (std::abs(wait_ms) < 1000 * kAfterAll_s) return Dawdle(wait_ms);
    }
    first_stamp_s_ = stamp_s;
    first_time_ = now;
}

void LiveEngine::Obey(const ViewerCommand& command) {
    switch (command.kind) {
        case ViewerCommand::Kind::kStop: stopped_ = true; break;
        case ViewerCommand::Kind::kRecord:
            if (Status status = recorder_.Start(command.path); !status.ok())
                Tell(FrameOutcome::Kind::kMessage, status.message());
            break;
        case ViewerCommand::Kind::kStopRecording: recorder_.Stop(); break;
        default:
            if (!commands_.TryPush(ViewerCommand(command)))
                Tell(FrameOutcome::Kind::kMessage, "too many commands at once: one was left out");
    }
}

void LiveEngine::Tell(FrameOutcome::Kind kind, const std::string& message) {
    FrameOutcome outcome;
    outcome.kind = kind;
    outcome.message = message;
    outcomes_.Push(std::move(outcome));
}

// ---- Tracking: newest frames and the map's news -> tasks.

void LiveEngine::TrackFrames() {
    BlockMap copy(config_.pipeline.map, BlockMap::Layers::kFieldOnly);
    TrackingStage stage(config_.pipeline, source_.camera);
    gate_.Begin(saved_tracking_, saved_pose_, true, stage);
    while (true) {
        tracking_wake_.Wait([&] { return !commands_.empty() || !new_frames_.empty() || reading_done_.load(); });
        ViewerCommand command;
        NewFrame item;
        if (commands_.TryPop(command)) {
            if (command.kind == ViewerCommand::Kind::kReset) {
                ++world_;
                stage.Reset();
                gate_.Open();
                copy.Clear();
            }
            Task task;
            task.command = command;
            Hand(std::move(task));
        } else if (new_frames_.TryPop(item)) {
            TrackFrame(std::move(item), copy, stage);
        } else if (reading_done_.load() && new_frames_.empty() && commands_.empty()) {
            break;
        }
    }
    tracking_done_.store(true);
    mapping_wake_.Notify();
}

void LiveEngine::TrackFrame(NewFrame item, BlockMap& copy, TrackingStage& stage) {
    ViewerSettings settings;
    if (viewer_ != nullptr && viewer_->settings.TryPop(settings)) {
        stage.Apply(settings);
        show_prediction_.store(settings.show_prediction);
    }
    TakeMapNews(copy);
    Task task;
    task.tracked = tracked_pool_.Take();
    plan_.Track(*item.frame, copy, stage, *task.tracked);
    gate_.AfterTracking(*item.frame, stage, *task.tracked);
    SaveTracking(stage, *task.tracked);
    Dawdle(config_.live.extra_tracking_ms);
    task.frame = std::move(item.frame);
    task.decode_ms = item.decode_ms;
    task.latency_ms = Milliseconds(Clock::now() - item.arrival).count();
    const bool first = task.tracked->report.first;
    Hand(std::move(task));
    if (first) tracking_wake_.Wait([&] { return !map_news_.empty(); });  // the next frame needs a map
}

// With the frame, so that a checkpoint after it holds the state after it.
void LiveEngine::SaveTracking(const TrackingStage& stage, TrackedFrame& tracked) const {
    tracked.tracking_state.clear();
    if (!scan_) return;
    StateWriter state(tracked.tracking_state);
    stage.SaveState(state);
}

void LiveEngine::TakeMapNews(BlockMap& copy) {
    MapNews news;
    while (map_news_.TryPop(news)) {
        if (news.world == world_) ApplyDelta(*news.delta, copy);
        delta_pool_.Give(std::move(news.delta));
    }
}

// Waits where mapping is far behind: it then leaves frames unfused until it has caught up.
void LiveEngine::Hand(Task task) {
    tracking_wake_.Wait([&] { return tasks_.TryPush(std::move(task)); });
}

// ---- Mapping: tasks -> the map, its news, meshes, outcomes.

void LiveEngine::MapFrames() {
    while (true) {
        mapping_wake_.Wait([&] {
            return !tasks_.empty() || tracking_done_.load() || (labelling_ && labelling_->has_answer());
        });
        if (labelling_) TakeLabels();
        Task task;
        if (tasks_.TryPop(task)) {
            tracking_wake_.Notify();
            if (task.tracked)
                MapFrame(task);
            else
                ObeyInMapping(task.command);
        } else if (tracking_done_.load() && tasks_.empty()) {
            break;
        }
    }
    if (scan_) {
        scan_->Finish(mapping_, nullptr);
        while (const auto message = scan_->TakeMessage()) Tell(FrameOutcome::Kind::kMessage, *message);
    }
    mapping_done_.store(true);
    outcome_wake_.Notify();
}

void LiveEngine::Save(const Task& task, FrameOutcome& outcome) {
    scan_->AfterFrame(*task.frame, *task.tracked, mapping_, nullptr, 0);
    outcome.scan_ms = scan_->last_ms();
    while (const auto message = scan_->TakeMessage()) Tell(FrameOutcome::Kind::kMessage, *message);
}

void LiveEngine::MapFrame(Task& task) {
    constexpr std::size_t kBehind = 2;
    TrackedFrame& tracked = *task.tracked;
    FrameOutcome outcome;
    if (tasks_.size() >= kBehind && tracked.to_fuse && !tracked.report.first) {
        tracked.to_fuse = false;
        outcome.fusion_dropped = true;
    }
    mapping_.Fuse(tracked);
    if (tracked.report.fused) {
        SendMapNews();
        Dawdle(config_.live.extra_mapping_ms);
    }
    feed_.ShowPrediction(show_prediction_.load());
    outcome.mesh_ms = feed_.Send(*task.frame, tracked.report, mapping_);
    if (scan_) Save(task, outcome);
    outcome.report = tracked.report;
    outcome.T_world_camera_truth = task.frame->T_world_camera;
    outcome.decode_ms = task.decode_ms;
    outcome.latency_ms = task.latency_ms;
    outcome.map = StatisticsOf(mapping_.map());
    outcome.labels = std::exchange(labels_, std::nullopt);
    outcome.queues = {{"to tracking", new_frames_.size()}, {"to mapping", tasks_.size()}, {"to recorder", recorder_.waiting()}, {"to scan", scan_ ? scan_->waiting() : 0}};
    outcomes_.Push(std::move(outcome));
    if (labelling_ && tracked.report.fused) OfferToLabelling(task);
    frame_pool_.Give(std::move(task.frame));
    tracked_pool_.Give(std::move(task.tracked));
}

void LiveEngine::OfferToLabelling(Task& task) {
    frame_pool_.Give(labelling_->Offer(
        {std::move(task.frame), task.tracked->report.track.T_world_camera, mapped_world_}));
}

void LiveEngine::TakeLabels() {
    LabellingThread::Answer answer;
    while (labelling_->TryTake(answer)) {
        if (!answer.message.empty()) Tell(FrameOutcome::Kind::kMessage, answer.message);
        if (answer.message.empty() && answer.job.world == mapped_world_) {
            Stopwatch watch;
            answer.report.votes = mapping_.Label(answer.report.detections, answer.job.frame->depth_m, answer.job.T_world_camera);
            answer.report.vote_ms = watch.LapMs();
            if (scan_) scan_->Touch(answer.report.votes.blocks);
            labels_ = std::move(answer.report);
        }
        frame_pool_.Give(std::move(answer.job.frame));
    }
}

// There is room: each news answers a frame that tracking handed over after it had taken all news before.
void LiveEngine::SendMapNews() {
    MapNews news{delta_pool_.Take(), mapped_world_};
    mapping_.CollectDelta(*news.delta);
    TESSERA_CHECK(map_news_.TryPush(std::move(news)), "more news of the map than frames");
}

void LiveEngine::ObeyInMapping(const ViewerCommand& command) {
    if (command.kind == ViewerCommand::Kind::kReset) {
        ++mapped_world_;
        mapping_.Reset();
        if (scan_) scan_->Reset();
        Tell(FrameOutcome::Kind::kReset, {});
    } else if (command.kind == ViewerCommand::Kind::kSaveMesh) {
        Tell(FrameOutcome::Kind::kMessage, SaveMesh(mapping_, command.path));
    }
    feed_.SendMesh(mapping_);
}

}  // namespace tessera
