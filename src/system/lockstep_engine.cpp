#include "system/lockstep_engine.h"

#include "core/stopwatch.h"
#include "io/mesh_io.h"

namespace tessera {

LockstepEngine::LockstepEngine(EngineInput input)
    : config_(input.config),
      plan_(std::move(input.plan)),
      viewer_(input.viewer),
      stop_(*input.stop),
      control_(input.viewer),
      source_(input.source->info()),
      tracking_(config_.pipeline, source_.camera, input.device),
      mapping_(config_.pipeline, config_.meshing, source_.camera, input.device),
      gate_(config_.pipeline.motion.max_gap_s),
      feed_(input.viewer, config_.live.mesh_blocks),
      recorder_(source_, config_.record, true) {
    if (!input.record_path.empty())
        status_ = StartRecording(input.record_path, config_.record, *input.source, recorder_);
    if (!status_.ok()) return;
    if (input.labelling.detector) {
        mapping_.EnableLabels(config_.labels, input.labelling.classes);
        loop_labels_ = LoopCloser::Labels{config_.labels, input.labelling.classes};
        labelling_ = std::make_unique<LabellingStage>(std::move(input.labelling.detector),
                                                      std::move(input.labelling.classes),
                                                      config_.labels, source_.camera);
    }
    if (input.scan.file) scan_path_ = input.scan.file->path();
    BeginLoops();
    if (input.scan.file) status_ = StartScan(std::move(input.scan));
    reader_ =
        std::make_unique<FrameReader>(std::move(input.source), input.selection, config_.read_ahead);
}

Status LockstepEngine::StartScan(ScanPlan plan) {
    double last_stamp_s = 0;
    if (plan.resumed) {
        gate_.Begin(plan.resumed->tracking, plan.resumed->LastPose(), !loops_, tracking_);
        fused_frames_ = plan.resumed->progress.labelled_frames;
        last_stamp_s = plan.resumed->progress.last_stamp_s;
    }
    scan_.emplace(std::move(plan), config_.scan, true, loops_.has_value());
    if (Status status = scan_->Resume(mapping_); !status.ok()) return status;
    if (auto memory = scan_->TakeLoops(); memory && loops_)
        loops_->Resume(std::move(*memory), last_stamp_s);
    return StartPaging(config_.pipeline, source_.camera, scan_->path(), true, paging_);
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
            case ReadStatus::kOk: Process(outcome); return true;
            case ReadStatus::kSkip: outcome.kind = FrameOutcome::Kind::kSkipped; return true;
            case ReadStatus::kWait:
                if (read.message.empty()) continue;
                outcome.kind = FrameOutcome::Kind::kMessage;
                return true;
            case ReadStatus::kError: status_ = Status::Error(read.message); [[fallthrough]];
            case ReadStatus::kEnd: ended = true;
        }
    }
    if (reader_) reader_->RequestStop();
    recorder_.Stop();
    if (loops_)
        if (std::string note =
                loops_->Finish([this](auto correction) { PutMap(std::move(correction)); });
            !note.empty())
            loops_message_ = std::move(note);
    if (paging_) paging_->Close();
    if (scan_ && loops_) scan_->AddLoops(loops_->TakeChanges());
    if (scan_) scan_->Finish(mapping_);
    return TakeMessage(outcome);
}

// Runs one frame through the whole pipeline.
void LockstepEngine::Process(FrameOutcome& outcome) {
    outcome.decode_ms = reader_->decode_ms();
    recorder_.Add(frame_);
    if (paging_) paging_->BeginFrame(mapping_, *scan_);
    if (labelling_) Detect();
    plan_.Select(frame_, tracking_);
    plan_.Track(frame_, tracking_.reads_map() ? mapping_.map() : mapping_.blocks(), tracking_,
                tracked_);
    gate_.AfterTracking(frame_, tracking_, tracked_);
    if (loops_)
        loops_->AfterTracking(frame_, mapping_.map(), tracking_, tracked_,
                              [this](const Eigen::Isometry3d& T_world_camera) {
                                  if (paging_)
                                      paging_->LoadAround(T_world_camera, mapping_, *scan_);
                              });
    if (paging_) outcome.fusion_dropped = paging_->AfterTracking(tracked_, mapping_, *scan_);
    mapping_.Fuse(tracked_);
    if (detected_ && tracked_.report.fused) Label(outcome);
    if (labelling_) fused_frames_ += tracked_.report.fused;
    if (loops_)
        outcome.loops_ms =
            loops_->AfterFusion(frame_, tracked_, outcome.labels, tracking_,
                                [this](auto correction) { PutMap(std::move(correction)); });
    if (scan_)
        Save(outcome);
    else if (viewer_ != nullptr)
        past_.push_back(RecordOf(frame_, tracked_));
    if (paging_) paging_->Release(mapping_, *scan_);
    outcome.report = tracked_.report;
    outcome.T_world_camera_truth = frame_.T_world_camera;
    outcome.mesh_ms = feed_.Send(frame_, outcome.report, mapping_);
    outcome.map = map_statistics();
}

void LockstepEngine::Save(FrameOutcome& outcome) {
    Stopwatch watch;
    tracked_.tracking_state.clear();
    StateWriter state(tracked_.tracking_state);
    tracking_.SaveState(state);
    scan_->AddFrame(frame_, tracked_, fused_frames_);
    if (loops_) scan_->AddLoops(loops_->TakeChanges());
    scan_->SaveIfDue(mapping_);
    outcome.scan_ms = watch.LapMs();
}

// Runs before tracking and fusion, because the detections may mask people in the frame.
void LockstepEngine::Detect() {
    detected_.reset();
    if (fused_frames_ % config_.labels.stride != 0) return;
    LabelReport report;
    if (!labelling_->Detect(frame_, report, label_message_)) return;
    if (!report.moving.depth_m.empty()) tracking_.HintMoving(report.moving, std::nullopt);
    detected_ = std::move(report);
}

void LockstepEngine::Label(FrameOutcome& outcome) {
    Stopwatch watch;
    detected_->votes =
        mapping_.Label(detected_->detections, frame_.depth_m, tracked_.report.track.T_world_camera);
    detected_->vote_ms = watch.LapMs();
    if (scan_) scan_->Touch(detected_->votes.blocks);
    outcome.labels = std::exchange(detected_, std::nullopt);
}

void LockstepEngine::BeginLoops() {
    if (!config_.loops.enabled) return;
    tracking_.KeepImages();
    loops_.emplace(config_.loops, config_.pipeline, source_, loop_labels_,
                   RebuildPagers(config_.pipeline, source_.camera, scan_path_));
}

void LockstepEngine::PutMap(LoopCloser::Correction correction) {
    PutInPlace(std::move(correction), mapping_, scan_, paging_.get());
}

bool LockstepEngine::TakeMessage(FrameOutcome& outcome) {
    std::optional<std::string> message = recorder_.TakeMessage();
    if (!message && scan_) message = scan_->TakeMessage();
    if (!message && paging_) message = paging_->TakeMessage();
    if (!message) message = std::exchange(loops_message_, std::nullopt);
    if (message) {
        outcome.kind = FrameOutcome::Kind::kMessage;
        outcome.message = std::move(*message);
        return true;
    }
    if (label_message_.empty()) return false;
    outcome.kind = FrameOutcome::Kind::kLabelsEnd;
    outcome.message = std::exchange(label_message_, {});
    return true;
}

bool LockstepEngine::HandleViewer(FrameOutcome& outcome) {
    while (true) {
        if (TakeMessage(outcome)) return true;
        ViewerSettings settings;
        if (viewer_ != nullptr && viewer_->settings.TryPop(settings)) {
            tracking_.Apply(settings);
            feed_.ShowPrediction(settings.show_prediction);
        }
        if (const auto command = control_.TakeCommand()) {
            if (Execute(*command, outcome)) return true;
            continue;
        }
        if (viewer_ != nullptr) viewer_->recording.store(recorder_.recording());
        stopped_ = stopped_ || stop_.load();
        if (stopped_ || control_.TakeTurn()) return false;
        feed_.SendMesh(mapping_);
        SleepBriefly();
    }
}

bool LockstepEngine::Execute(const ViewerCommand& command, FrameOutcome& outcome) {
    outcome.kind = FrameOutcome::Kind::kMessage;
    switch (command.kind) {
        case ViewerCommand::Kind::kReset:
            tracking_.Reset();
            gate_.Open();
            mapping_.Reset();
            BeginLoops();
            if (scan_) scan_->Reset();
            past_.clear();
            if (paging_) paging_->Reset();
            feed_.SendMesh(mapping_);
            outcome.kind = FrameOutcome::Kind::kReset;
            return true;
        case ViewerCommand::Kind::kSaveMesh:
            outcome.message =
                SaveMesh(mapping_, command.path) + (paging_ ? paging_->MissingText(*scan_) : "");
            return true;
        case ViewerCommand::Kind::kSaveScan:
            outcome.message = SaveScan(command.path, source_, config_, true, past_, scan_);
            return true;
        case ViewerCommand::Kind::kRecord:
            if (Status status = recorder_.Start(command.path); !status.ok()) {
                outcome.message = status.message();
                return true;
            }
            return false;
        case ViewerCommand::Kind::kStopRecording: recorder_.Stop(); return false;
        case ViewerCommand::Kind::kStop: stopped_ = true; return false;
        default: return false;
    }
}

std::vector<StampedPose> LockstepEngine::CorrectedPath() const {
    return loops_ ? loops_->Path() : std::vector<StampedPose>();
}

TriangleMesh LockstepEngine::TakeMesh() {
    reader_.reset();
    return TakeFinalMesh(mapping_, scan_, paging_.get(), status_);
}

}  // namespace tessera
