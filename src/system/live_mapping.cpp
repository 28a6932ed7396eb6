#include "system/live_mapping.h"

#include <cmath>

#include "core/check.h"
#include "system/loop_stage.h"

namespace tessera {

LiveMapping::LiveMapping(const RunConfig& config, const SourceInfo& source, Backend* device,
                         ViewerLink* viewer, LiveLinks& links)
    : config_(config),
      source_(source),
      one_thread_(device != nullptr),
      links_(links),
      life_(config, source, device, viewer, false, links.notices) {
    if (!one_thread_) life_.stage().KeepDeltas();
}

// ---- The start.

Status LiveMapping::Start(Labelling labelling, OpenDetectorFunction open_detector, ScanPlan plan) {
    open_detector_ = std::move(open_detector);
    std::optional<LoopCloser::Labels> labels;
    if (labelling.detector) {
        labels = LoopCloser::Labels{config_.labels, labelling.classes};
        StartLabels(std::move(labelling));
    }
    Result<std::optional<LoopCloser::Memory>> learnt = life_.StartScan(std::move(plan));
    if (!learnt.ok()) return learnt.status();
    links_.saving.store(life_.saving());
    if (!one_thread_ && life_.stage().map().size() > 1)
        field_ = CopyLayers(life_.stage().map(), config_.pipeline.trackers.layers());
    if (config_.loops.enabled) StartLoops(std::move(labels), std::move(learnt.value()));
    if (!one_thread_)
        worker_.emplace(
            LiveLinks::kTasks,
            [this](MappingTask& task) {
                TakeAnswers();
                Process(task);
            },
            WorkerOptions{
                .wake = &links_.mapping,
                .has_idle_work = [this] { return HasAnswers() || life_.feed().MeshWaits(); },
                .idle =
                    [this] {
                        TakeAnswers();
                        if (life_.feed().Paused()) life_.SendMesh();
                    },
                .end = [this](bool) { End(); }});
    return Status::Ok();
}

void LiveMapping::StartLabels(Labelling labelling) {
    life_.stage().EnableLabels(config_.labels, labelling.classes);
    labelling_ = std::make_unique<LabellingThread>(
        LabellingStage(std::move(labelling.detector), std::move(labelling.classes), config_.labels,
                       source_.camera),
        open_detector_, links_.mapping);
}

// Also without labels so far: then they begin when it is open.
void LiveMapping::ChangeDetector(const std::string& name) {
    if (!labelling_)
        labelling_ = std::make_unique<LabellingThread>(
            LabellingStage(config_.labels, source_.camera), open_detector_, links_.mapping);
    labelling_->Change(name);
}

void LiveMapping::StartLoops(std::optional<LoopCloser::Labels> labels,
                             std::optional<LoopCloser::Memory> resumed) {
    LoopThread::Settings settings{config_.EffectiveLoops(),
                                  FieldSettingsOf(config_.pipeline, source_.camera),
                                  source_.depth_units_per_m,
                                  std::move(labels),
                                  life_.saving(),
                                  std::move(resumed)};
    settings.tracked_layers = config_.pipeline.trackers.layers();
    settings.make_pager = life_.MakePagers();
    settings.only_answers = life_.only_localise();
    loops_ = std::make_unique<LoopThread>(
        std::move(settings),
        LoopThread::Surroundings{links_.frames, links_.tracked_frames, links_.mapping,
                                 links_.tracking, links_.notices});
}

// ---- Tracking thread.

void LiveMapping::Send(MappingTask task) {
    if (worker_) return worker_->PushOrWait(std::move(task));
    Process(task);
}

void LiveMapping::Finish() {
    if (worker_) return worker_->Finish();
    End();
}

// ---- The life of a frame.

void LiveMapping::Process(MappingTask& task) {
    if (task.tracked)
        MapFrame(task);
    else
        Execute(task.command);
}

void LiveMapping::MapFrame(MappingTask& task) {
    constexpr std::size_t kBehind = 2;
    TrackedFrame& tracked = *task.tracked;
    FrameOutcome outcome;
    if (worker_ && worker_->waiting() >= kBehind && tracked.to_fuse && !tracked.report.first) {
        tracked.to_fuse = false;
        outcome.fusion_dropped = true;
    }
    Carry(corrections_, task.corrections, tracked.report.track.T_world_camera);
    Carry(corrections_, task.corrections, tracked.view.T_world_camera);
    // If a lost camera was relocalised in a paged-out part, that part is loaded now, and tracking
    // succeeds there at a later relocalisation.
    if (task.T_found_camera && life_.paging() != nullptr) {
        Carry(corrections_, task.corrections, *task.T_found_camera);
        life_.paging()->Expect(*task.T_found_camera);
    }
    if (task.labels) life_.Apply(*task.labels);
    if (!task.detector.empty()) ChangeDetector(task.detector);
    life_.Begin();
    life_.Fuse(tracked, outcome);
    // Tracking waits for the answer to a first frame, fused or not.
    if (!one_thread_ && (tracked.report.first || tracked.report.fused || life_.stage().has_delta()))
        SendMapUpdate(tracked.report.first);
    if (tracked.report.fused) WaitFor(config_.live.extra_mapping_ms);
    life_.Record(*task.frame, tracked, 0, outcome);
    life_.Save(outcome);
    life_.feed().ShowPrediction(links_.show_prediction.load());
    life_.Report(*task.frame, tracked, outcome);
    outcome.decode_ms = task.decode_ms;
    outcome.latency_ms = task.latency_ms;
    outcome.queues = {{"to tracking", links_.new_frames.load()},
                      {"to mapping", worker_ ? worker_->waiting() : 0},
                      {"to recorder", links_.to_recorder.load()}};
    if (loops_) outcome.queues.emplace_back("to loops", loops_->waiting());
    if (life_.saving()) outcome.queues.emplace_back("to scan", life_.checkpoints_waiting());
    links_.outcomes.Push(std::move(outcome));
    Offer(task);
}

// The queue has room: each update answers a frame that tracking sent after taking all earlier
// updates, and corrections have reserved places (UpdateFits).
void LiveMapping::SendMapUpdate(bool first) {
    MapUpdate update{links_.deltas.Take(), world_, nullptr};
    update.first = first;
    life_.stage().CollectDelta(*update.delta);
    TESSERA_CHECK(links_.map_updates.TryPush(std::move(update)), "more map updates than frames");
}

// Also if the source's clock was set back.
bool LiveMapping::DetectionDue(double stamp_s) const {
    return !last_detection_s_ ||
           std::abs(stamp_s - *last_detection_s_) >= 1 / config_.labels.max_rate_hz;
}

// Passes the frame on to labelling and loop closure, which process it in the background.
void LiveMapping::Offer(MappingTask& task) {
    const FrameReport& report = task.tracked->report;
    if (labelling_ && life_.labelling() && report.fused && DetectionDue(report.stamp_s)) {
        last_detection_s_ = report.stamp_s;
        std::unique_ptr<Frame> frame = links_.frames.Take();
        if (loops_)
            *frame = *task.frame;
        else
            std::swap(frame, task.frame);
        const Frame* offered = frame.get();
        std::unique_ptr<Frame> needless =
            labelling_->Offer({std::move(frame), report.track.T_world_camera, version()});
        if (life_.paging() != nullptr && needless.get() != offered)
            life_.paging()->Hold(report.index, report.track.T_world_camera);
        else if (life_.paging() != nullptr && labelling_->stopped())
            life_.paging()->ReleaseHold(report.index);  // no detections are to come
        links_.frames.Give(std::move(needless));
    }
    if (loops_ && report.tracked() && !life_.only_localise())
        loops_->Offer(std::move(task.tracked), std::move(task.frame), version());
    links_.frames.Give(std::move(task.frame));
    links_.tracked_frames.Give(std::move(task.tracked));
}

// ---- Commands of the user.

void LiveMapping::Execute(const ViewerCommand& command) {
    switch (command.kind) {
        case ViewerCommand::Kind::kReset: Reset(); break;
        case ViewerCommand::Kind::kSaveMesh: life_.SaveMesh(command.path); break;
        case ViewerCommand::Kind::kSaveScan:
            life_.SaveScan(command.path);
            if (life_.saving() && !links_.saving.exchange(true) && loops_) loops_->BeginNews();
            break;
        default: break;
    }
    life_.SendMesh();
}

void LiveMapping::Reset() {
    ++world_;
    corrections_.clear();
    last_detection_s_.reset();
    if (loops_) loops_->Reset(version());
    life_.Reset();
    links_.Report(FrameOutcome::Kind::kReset, {});
}

// ---- The end.

void LiveMapping::End() {
    if (labelling_ && !links_.quit.load()) labelling_->Finish();
    while (labelling_ && labelling_->has_answer()) TakeLabels();
    if (loops_ && !links_.quit.load() && !life_.only_localise()) {
        const auto take_all = [this] {
            LoopThread::Update update;
            while (loops_->TryTake(update)) TakeUpdate(std::move(update), true);
            while (life_.stage().following()) life_.stage().Follow();
        };
        loops_->Settle();
        copier_.Stop();
        take_all();
        loops_->Finish(life_.whole_map(), version());
        take_all();
    }
    life_.Finish();
}

void LiveMapping::Save(const ViewerCommand& command) {
    life_.SaveAfterEnd(command, [this] { return loops_ ? loops_->TakeAll() : LoopChanges(); });
}

}  // namespace tessera
