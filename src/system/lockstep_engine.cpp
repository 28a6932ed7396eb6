#include "system/lockstep_engine.h"

namespace tessera {

LockstepEngine::LockstepEngine(EngineInput input)
    : config_(input.config),
      viewer_(input.viewer),
      stop_(*input.stop),
      control_(input.viewer),
      source_(input.source->info()),
      tracking_(config_, source_.camera, input.device, std::move(input.plan)),
      mapping_(config_, source_, input.device, input.viewer, true, notices_),
      recorder_(source_, config_.record, true, notices_),
      labelling_(config_.labels, source_.camera, std::move(input.open_detector)) {
    if (!input.record_path.empty()) status_ = recorder_.Start(input.record_path, *input.source);
    if (!status_.ok()) return;
    if (input.labelling.detector) {
        EnableLabels(input.labelling.classes);
        labelling_.Begin(std::move(input.labelling));
    }
    if (input.scan.only_localise()) control_.KeepMap(notices_);
    status_ = StartScan(std::move(input.scan));
    reader_ =
        std::make_unique<FrameReader>(std::move(input.source), input.selection, config_.read_ahead);
}

Status LockstepEngine::StartScan(ScanPlan plan) {
    std::optional<TrackingResume> resume;
    if (plan.resumed) {
        resume = TrackingResume::Of(plan);
        tracking_.Resume(*resume);
        labelling_.Resume(plan.resumed->progress.labelled_frames);
    }
    Result<std::optional<LoopCloser::Memory>> learnt = mapping_.StartScan(std::move(plan));
    if (!learnt.ok()) return learnt.status();
    BeginLoops();
    if (loops_ && resume)
        loops_->Resume(std::move(*learnt.value()), resume->last_seen_s, resume->lost);
    return Status::Ok();
}

void LockstepEngine::BeginLoops() {
    if (!config_.loops.enabled) return;
    loops_.emplace(config_.EffectiveLoops(), config_.pipeline, source_, loop_labels_,
                   mapping_.MakePagers());
    loops_->Switch(loops_on_);
}

bool LockstepEngine::Next(FrameOutcome& outcome) {
    outcome = {};
    bool ended = !status_.ok();
    while (!ended) {
        if (HandleViewer(outcome)) return true;
        if (stopped_) break;
        const ReadResult read = reader_->Next(frame_);
        outcome.message = read.message;
        switch (read.status) {
            case ReadStatus::kOk:
                control_.TakeTurn();
                Process(outcome);
                return true;
            case ReadStatus::kSkip: outcome.kind = FrameOutcome::Kind::kSkipped; return true;
            case ReadStatus::kWait:
                if (read.message.empty()) continue;
                outcome.kind = FrameOutcome::Kind::kMessage;
                return true;
            case ReadStatus::kError: status_ = Status::Error(read.message); [[fallthrough]];
            case ReadStatus::kEnd: ended = true;
        }
    }
    Finish();
    return TakeMessage(outcome);
}

// ---- The life of a frame.

void LockstepEngine::Process(FrameOutcome& outcome) {
    outcome.decode_ms = reader_->decode_ms();
    recorder_.Add(frame_);
    mapping_.Begin();
    if (mapping_.labelling()) labelling_.Detect(frame_, false, tracking_.stage());
    tracking_.Begin(frame_);
    tracking_.Track(frame_, mapping_.MapFor(tracking_.stage()), tracked_);
    RelocaliseIfLost();
    tracking_.End(tracked_);
    mapping_.Fuse(tracked_, outcome);
    Label(outcome);
    CloseLoops(outcome);
    if (mapping_.saving()) tracking_.SaveState(tracked_);
    mapping_.Record(frame_, tracked_, labelling_.frames(), outcome);
    if (loops_ && mapping_.saving()) mapping_.AddLoops(loops_->TakeChanges());
    mapping_.Save(outcome);
    mapping_.Report(frame_, tracked_, outcome);
}

void LockstepEngine::Label(FrameOutcome& outcome) {
    if (!mapping_.labelling() || !tracked_.report.fused) return;
    std::optional<LabelReport> detected = labelling_.TakeDetections();
    if (!detected) return;
    mapping_.Label(frame_.depth_m, tracked_.report.track.T_world_camera, *detected);
    outcome.labels = std::move(detected);
}

void LockstepEngine::RelocaliseIfLost() {
    if (!loops_) return;
    loops_->AfterTracking(frame_, mapping_.stage().map(), tracking_.stage(), tracked_,
                          [this](const auto& pose) { mapping_.LoadAround(pose); });
}

void LockstepEngine::CloseLoops(FrameOutcome& outcome) {
    if (!loops_ || mapping_.only_localise()) return;
    outcome.loops_ms =
        loops_->AfterFusion(frame_, tracked_, outcome.labels, tracking_.stage(),
                            [this](auto correction) { mapping_.PutMap(std::move(correction)); });
}

// ---- The user.

bool LockstepEngine::TakeMessage(FrameOutcome& outcome) {
    if (std::optional<std::string> message = notices_.Take()) {
        outcome.kind = FrameOutcome::Kind::kMessage;
        outcome.message = std::move(*message);
        return true;
    }
    if (DetectorChange begun = labelling_.TakeBegun(); begun.classes) {
        outcome.kind = FrameOutcome::Kind::kLabelsBegin;
        outcome.classes = std::move(begun.classes);
        outcome.detector = std::move(begun.detector);
        return true;
    }
    const std::string failure = labelling_.TakeFailure();
    if (failure.empty()) return false;
    outcome.kind = FrameOutcome::Kind::kLabelsEnd;
    outcome.message = LabellingStopped(failure);
    return true;
}

void LockstepEngine::Apply(const ViewerSettings& settings) {
    notices_.Tell(tracking_.stage().Apply(settings));
    mapping_.Apply(settings.labels);
    loops_on_ = settings.loops.value_or(true);
    tracking_.SetSeeking(loops_on_);
    if (loops_) loops_->Switch(loops_on_);
    mapping_.feed().ShowPrediction(settings.show_prediction);
    // Also without labels so far: then they begin here.
    if (std::optional<DetectorChange> change = labelling_.Choose(settings)) {
        notices_.Tell(std::move(change->message));
        if (change->classes && !mapping_.stage().has_labels()) EnableLabels(*change->classes);
    }
}

void LockstepEngine::EnableLabels(const LabelClasses& classes) {
    mapping_.stage().EnableLabels(config_.labels, classes);
    loop_labels_ = LoopCloser::Labels{config_.labels, classes};
    if (loops_) loops_->EnableLabels(*loop_labels_);
}

// Waits while paused. Returns true if there is something to report.
bool LockstepEngine::HandleViewer(FrameOutcome& outcome) {
    while (true) {
        if (TakeMessage(outcome)) return true;
        ViewerSettings settings;
        if (viewer_ != nullptr && viewer_->settings.TryPop(settings)) {
            Apply(settings);
            continue;  // there may be something to tell
        }
        if (const auto command = control_.TakeCommand()) {
            if (Execute(*command, outcome)) return true;
            continue;
        }
        if (viewer_ != nullptr) viewer_->recording.store(recorder_.recording());
        stopped_ = stopped_ || stop_.load();
        if (stopped_ || !control_.waiting()) return false;
        mapping_.SendMesh();
        RunControl::SleepBriefly();
    }
}

// Returns true if there is something to report besides messages.
bool LockstepEngine::Execute(const ViewerCommand& command, FrameOutcome& outcome) {
    switch (command.kind) {
        case ViewerCommand::Kind::kReset:
            tracking_.Reset();
            mapping_.Reset();
            BeginLoops();
            outcome.kind = FrameOutcome::Kind::kReset;
            return true;
        case ViewerCommand::Kind::kSaveMesh: mapping_.SaveMesh(command.path); break;
        case ViewerCommand::Kind::kSaveScan: mapping_.SaveScan(command.path); break;
        case ViewerCommand::Kind::kRecord:
            if (Status status = recorder_.Start(command.path); !status.ok())
                notices_.Tell(status.message());
            break;
        case ViewerCommand::Kind::kStopRecording: recorder_.Stop(); break;
        case ViewerCommand::Kind::kStop: stopped_ = true; break;
        default: break;
    }
    return false;
}

// ---- The end.

void LockstepEngine::Finish() {
    if (std::exchange(finished_, true)) return;
    if (reader_) reader_->RequestStop();
    recorder_.Stop();
    if (loops_ && !mapping_.only_localise()) {
        notices_.Tell(
            loops_->Finish([this](auto correction) { mapping_.PutMap(std::move(correction)); },
                           [this] { mapping_.stage().FreeMap(); }));
        if (mapping_.saving()) mapping_.AddLoops(loops_->TakeChanges());
    }
    mapping_.Finish();
}

std::vector<StampedPose> LockstepEngine::CorrectedPath() const {
    return loops_ && !mapping_.only_localise() ? loops_->Path() : std::vector<StampedPose>();
}

TriangleMesh LockstepEngine::TakeMesh() {
    reader_.reset();
    return mapping_.TakeMesh(status_, keep_map_);
}

void LockstepEngine::Save(const ViewerCommand& command) {
    mapping_.SaveAfterEnd(command, [this] { return loops_ ? loops_->TakeAll() : LoopChanges(); });
}

}  // namespace tessera
