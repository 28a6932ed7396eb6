// LiveEngine's mapping thread: takes tasks; updates the map, the meshes and tracking's copy of the
// map; sends outcomes.
#include "core/check.h"
#include "core/stopwatch.h"
#include "system/live_engine.h"

namespace tessera {

void LiveEngine::MapFrames() {
    while (true) {
        mapping_wake_.Wait(
            [&] { return !tasks_.empty() || tracking_done_.load() || HasAnswers(); });
        if (!MapNext() && tracking_done_.load() && tasks_.empty()) break;
    }
    EndMapping();
}

bool LiveEngine::HasAnswers() const {
    return (labelling_ && labelling_->has_answer()) || UpdateFits();
}

// Takes results from other threads, then one task. Returns false if there was no task.
bool LiveEngine::MapNext() {
    if (labelling_) TakeLabels();
    if (loops_) TakeLoops();
    Task task;
    if (!tasks_.TryPop(task)) return false;
    tracking_wake_.Notify();
    if (task.tracked)
        MapFrame(task);
    else
        ExecuteInMapping(task.command);
    return true;
}

void LiveEngine::EndMapping() {
    if (loops_) EndLoops();
    if (paging_) {
        paging_->Close();
        if (const auto message = paging_->TakeMessage())
            Report(FrameOutcome::Kind::kMessage, *message);
    }
    if (scan_) {
        scan_->Finish(mapping_);
        while (const auto message = scan_->TakeMessage())
            Report(FrameOutcome::Kind::kMessage, *message);
    }
    mapping_done_.store(true);
    outcome_wake_.Notify();
}

void LiveEngine::MapFrame(Task& task) {
    constexpr std::size_t kBehind = 2;
    TrackedFrame& tracked = *task.tracked;
    FrameOutcome outcome;
    if (tasks_.size() >= kBehind && tracked.to_fuse && !tracked.report.first) {
        tracked.to_fuse = false;
        outcome.fusion_dropped = true;
    }
    Carry(corrections_, task.corrections, tracked.report.track.T_world_camera);
    Carry(corrections_, task.corrections, tracked.view.T_world_camera);
    if (paging_) Page(task, outcome);
    mapping_.Fuse(tracked);
    if (device_ == nullptr && (tracked.report.fused || mapping_.has_delta())) SendMapUpdate();
    if (tracked.report.fused) WaitFor(config_.live.extra_mapping_ms);
    feed_.ShowPrediction(show_prediction_.load());
    outcome.mesh_ms = feed_.Send(*task.frame, tracked.report, mapping_);
    if (scan_)
        Save(task, outcome);
    else if (viewer_ != nullptr)
        past_.push_back(RecordOf(*task.frame, tracked));
    if (paging_) paging_->Release(mapping_, *scan_);
    outcome.report = tracked.report;
    outcome.T_world_camera_truth = task.frame->T_world_camera;
    outcome.decode_ms = task.decode_ms;
    outcome.latency_ms = task.latency_ms;
    outcome.map = map_statistics();
    outcome.labels = std::exchange(labels_, std::nullopt);
    outcome.queues = {{"to tracking", new_frames_.size()},
                      {"to mapping", tasks_.size()},
                      {"to recorder", recorder_.waiting()}};
    if (loops_) outcome.queues.emplace_back("to loops", loops_->waiting());
    if (scan_) outcome.queues.emplace_back("to scan", scan_->waiting());
    outcomes_.Push(std::move(outcome));
    Offer(task);
}

// Loads paged-out parts of the map. If a lost camera was relocalised in a paged-out part, that part
// is loaded now, and tracking succeeds there at a later relocalisation.
void LiveEngine::Page(Task& task, FrameOutcome& outcome) {
    if (task.T_found_camera) {
        Carry(corrections_, task.corrections, *task.T_found_camera);
        paging_->Expect(*task.T_found_camera);
    }
    paging_->BeginFrame(mapping_, *scan_);
    if (paging_->AfterTracking(*task.tracked, mapping_, *scan_)) outcome.fusion_dropped = true;
    if (const auto message = paging_->TakeMessage()) Report(FrameOutcome::Kind::kMessage, *message);
}

void LiveEngine::Save(const Task& task, FrameOutcome& outcome) {
    Stopwatch watch;
    scan_->AddFrame(*task.frame, *task.tracked, 0);
    scan_->SaveIfDue(mapping_);
    outcome.scan_ms = watch.LapMs();
    while (const auto message = scan_->TakeMessage())
        Report(FrameOutcome::Kind::kMessage, *message);
}

// After a frame was fused, passes it on to labelling and loop closure, which process it in the
// background.
void LiveEngine::Offer(Task& task) {
    const FrameReport& report = task.tracked->report;
    const MapVersion version{mapped_world_, static_cast<int>(corrections_.size())};
    if (labelling_ && report.fused && report.stamp_s >= next_detection_s_) {
        next_detection_s_ = report.stamp_s + 1 / config_.labels.max_rate_hz;
        std::unique_ptr<Frame> frame = frame_pool_.Take();
        if (loops_)
            *frame = *task.frame;
        else
            std::swap(frame, task.frame);
        const Frame* offered = frame.get();
        std::unique_ptr<Frame> needless =
            labelling_->Offer({std::move(frame), report.track.T_world_camera, version});
        if (paging_ && needless.get() != offered)
            paging_->Hold(report.index, report.track.T_world_camera);
        frame_pool_.Give(std::move(needless));
    }
    if (loops_ && report.tracked())
        loops_->Offer(std::move(task.tracked), std::move(task.frame), version);
    frame_pool_.Give(std::move(task.frame));
    tracked_pool_.Give(std::move(task.tracked));
}

void LiveEngine::TakeLabels() {
    LabellingThread::Answer answer;
    while (labelling_->TryTake(answer)) {
        LabellingThread::Job& job = answer.job;
        if (paging_ && job.map.world == mapped_world_) paging_->ReleaseHold(job.frame->index);
        if (!answer.message.empty()) Report(FrameOutcome::Kind::kLabelsEnd, answer.message);
        if (answer.message.empty() && job.map.world == mapped_world_) {
            Stopwatch watch;
            Carry(corrections_, job.map.corrections, job.T_world_camera);
            answer.report.votes =
                mapping_.Label(answer.report.detections, job.frame->depth_m, job.T_world_camera);
            answer.report.vote_ms = watch.LapMs();
            if (!answer.report.moving.depth_m.empty())
                hints_.Push({std::move(answer.report.moving),
                             job.T_world_camera,
                             {mapped_world_, static_cast<int>(corrections_.size())}});
            if (scan_) scan_->Touch(answer.report.votes.blocks);
            if (loops_)
                loops_->OfferDetections(job.frame->index, answer.report.detections, job.map);
            labels_ = std::move(answer.report);
        }
        frame_pool_.Give(std::move(job.frame));
    }
}

// The queue has room: each update answers a frame that tracking sent after taking all earlier
// updates, and corrections have reserved places (UpdateFits).
void LiveEngine::SendMapUpdate() {
    MapUpdate news{delta_pool_.Take(), mapped_world_, nullptr};
    mapping_.CollectDelta(*news.delta);
    TESSERA_CHECK(map_updates_.TryPush(std::move(news)), "more map updates than frames");
}

bool LiveEngine::UpdateFits() const {
    return loops_ && loops_->has_update() && map_updates_.size() < kCorrections;
}

void LiveEngine::TakeLoops() {
    LoopThread::Update update;
    while (UpdateFits() && loops_->TryTake(update)) TakeUpdate(std::move(update), false);
    ReportLoopMessages();
}

// Puts the corrected map in place for mapping and the scan, and for tracking unless it has ended.
void LiveEngine::TakeUpdate(LoopThread::Update update, bool last) {
    if (update.world != mapped_world_) return;
    if (update.correction) {
        const Eigen::Isometry3d T_new_old = update.correction->T_new_old;
        PutInPlace(std::move(*update.correction), mapping_, scan_, paging_.get());
        corrections_.push_back(T_new_old);
        if (scan_) scan_->Move(T_new_old);
        if (!last)
            TESSERA_CHECK(
                map_updates_.TryPush({nullptr, mapped_world_, std::move(update.field), T_new_old}),
                "more corrections than the queue has room for");
        Report(FrameOutcome::Kind::kMessage, "map corrected");
        feed_.SendMesh(mapping_);
    }
    if (scan_) scan_->AddLoops(std::move(update.news));
}

// End of the run: waits for all pending corrections.
void LiveEngine::EndLoops() {
    if (quit_.load()) return;
    loops_->Finish([this](const std::string& news) { Report(FrameOutcome::Kind::kMessage, news); });
    LoopThread::Update update;
    while (loops_->TryTake(update)) TakeUpdate(std::move(update), true);
}

void LiveEngine::ReportLoopMessages() {
    std::string news;
    while (loops_->TryTakeChanges(news)) Report(FrameOutcome::Kind::kMessage, news);
}

void LiveEngine::ExecuteInMapping(const ViewerCommand& command) {
    if (command.kind == ViewerCommand::Kind::kReset) {
        ++mapped_world_;
        corrections_.clear();
        next_detection_s_ = 0;
        mapping_.Reset();
        if (loops_) loops_->Reset({mapped_world_, 0});
        if (scan_) scan_->Reset();
        past_.clear();
        if (paging_) paging_->Reset();
        Report(FrameOutcome::Kind::kReset, {});
    } else if (command.kind == ViewerCommand::Kind::kSaveMesh) {
        Report(FrameOutcome::Kind::kMessage,
               SaveMesh(mapping_, command.path) + (paging_ ? paging_->MissingText(*scan_) : ""));
    } else if (command.kind == ViewerCommand::Kind::kSaveScan) {
        Report(FrameOutcome::Kind::kMessage,
               SaveScan(command.path, source_, config_, false, past_, scan_));
        if (scan_ && !saving_.exchange(true) && loops_) loops_->BeginNews();
    }
    feed_.SendMesh(mapping_);
}

}  // namespace tessera
