#include "system/live_tracking.h"

namespace tessera {

using Question = CameraSearch::Question;

namespace {

CameraSearch SearchFor(const LiveTracking::Settings& settings) {
    return {settings.config.loops, settings.config.pipeline.motion.max_gap_s, settings.camera};
}

}  // namespace

LiveTracking::State::State(const Settings& settings, FramePlan plan,
                           std::unique_ptr<BlockMap> resumed_field)
    : life(settings.config, settings.camera, settings.device, std::move(plan)),
      field(std::move(resumed_field)),
      search(SearchFor(settings)) {
    const PipelineConfig& config = settings.config.pipeline;
    if (!field) field = std::make_unique<BlockMap>(config.map, config.trackers.layers());
    if (!settings.resume) return;
    life.Resume(*settings.resume);
    search.Resume(settings.resume->last_seen_s, settings.resume->lost);
}

LiveTracking::LiveTracking(Settings settings, FramePlan plan, LiveLinks& links,
                           LiveMapping& mapping)
    : settings_(std::move(settings)),
      plan_(std::move(plan)),
      links_(links),
      mapping_(mapping),
      loops_(mapping.loops()),
      worker_(
          static_cast<std::size_t>(settings_.config.live.queue_frames),
          [this](NewFrame& item) {
              TakeCommands();
              mapping_.TakeAnswersHere();
              Track(item);
          },
          {.wake = &links_.tracking,
           .has_idle_work = [this] { return !commands_.empty() || mapping_.HasAnswersToTake(); },
           .idle =
               [this] {
                   mapping_.TakeAnswersHere();
                   TakeCommands();
               },
           .begin = [this] { state_.emplace(settings_, std::move(plan_), mapping_.TakeField()); },
           .end =
               [this](bool) {
                   TakeCommands();
                   state_.reset();
                   mapping_.Finish();
               }}) {}

void LiveTracking::TakeCommands() {
    ViewerCommand command;
    while (commands_.TryPop(command)) {
        if (command.kind == ViewerCommand::Kind::kReset) Reset();
        MappingTask task;
        task.command = std::move(command);
        mapping_.Send(std::move(task));
    }
}

void LiveTracking::Reset() {
    state_->version = {state_->version.world + 1, 0};
    state_->life.Reset();
    state_->field->Clear();
    state_->search = SearchFor(settings_);
    state_->looked_for = false;
}

// ---- The life of a frame.

void LiveTracking::Track(NewFrame& item) {
    const Frame& frame = *item.frame;
    FrameTracking& life = state_->life;
    TakeSettings();
    ApplyMapUpdates();
    TakeHint();
    MappingTask task;
    task.tracked = links_.tracked_frames.Take();
    task.labels = std::exchange(state_->labels, std::nullopt);
    task.detector = std::exchange(state_->detector, {});
    task.T_found_camera = TakeRelocalisation(frame.stamp_s);
    life.SetSeeking(state_->seeking && state_->looked_for && !task.T_found_camera);
    life.Begin(frame);
    life.Track(frame, MapToTrackIn(), *task.tracked);
    Search(*task.tracked);
    life.End(*task.tracked);
    task.tracked->tracking_state.clear();
    if (links_.saving.load()) life.SaveState(*task.tracked);
    WaitFor(settings_.config.live.extra_tracking_ms);
    task.decode_ms = item.decode_ms;
    task.latency_ms =
        std::chrono::duration<double, std::milli>(LiveClock::now() - item.arrival).count();
    task.corrections = state_->version.corrections;
    task.frame = std::move(item.frame);
    const bool first = task.tracked->report.first;
    mapping_.Send(std::move(task));
    // The next frame needs a map.
    if (first && settings_.device == nullptr)
        links_.tracking.Wait([this] { return ApplyMapUpdates(); });
}

const BlockMap& LiveTracking::MapToTrackIn() const {
    return settings_.device == nullptr ? *state_->field : mapping_.MapFor(state_->life.stage());
}

void LiveTracking::TakeSettings() {
    ViewerSettings settings;
    if (settings_.viewer == nullptr || !settings_.viewer->settings.TryPop(settings)) return;
    links_.notices.Tell(state_->life.stage().Apply(settings));
    links_.show_prediction.store(settings.show_prediction);
    state_->labels = settings.labels;
    if (std::exchange(state_->detector_choice, settings.detector_choice) !=
        settings.detector_choice)
        state_->detector = settings.detector;
    state_->seeking = settings.loops.value_or(true);
    if (loops_ != nullptr) loops_->SetSeeking(state_->seeking);
}

// Returns whether one of this world answers a first frame.
bool LiveTracking::ApplyMapUpdates() {
    MapUpdate update;
    bool answered = false;
    while (links_.map_updates.TryPop(update)) {
        const bool ours = update.world == state_->version.world;
        if (ours && update.field) {
            state_->field = std::move(update.field);
            state_->life.stage().Move(update.T_new_old);
            state_->search.Move(update.T_new_old);
            ++state_->version.corrections;
        }
        if (ours && update.delta) ApplyDelta(*update.delta, *state_->field);
        links_.deltas.Give(std::move(update.delta));
        answered |= ours && update.first;
    }
    return answered;
}

void LiveTracking::TakeHint() {
    LiveHint hint;
    if (links_.hints.TryPop(hint) && hint.map == state_->version)
        state_->life.stage().HintMoving(hint.moving, hint.T_world_camera);
}

// ---- A lost camera.

std::optional<Eigen::Isometry3d> LiveTracking::TakeRelocalisation(double stamp_s) {
    LoopThread::Answer answer;
    if (loops_ == nullptr || !loops_->TryTake(answer)) return std::nullopt;
    state_->asked = false;
    if (answer.obsolete || answer.map != state_->version) return std::nullopt;
    if (answer.check) {
        const char* note = "";
        state_->search.TakeSecondView(answer.found, note);
        links_.notices.Tell(note);
        return std::nullopt;
    }
    state_->looked_for = true;
    const auto T_found_camera = state_->search.TakeWhere(answer.found, stamp_s);
    if (!T_found_camera) return std::nullopt;
    links_.notices.Tell(answer.note);
    state_->life.stage().Relocate({answer.stamp_s, *T_found_camera});
    return T_found_camera;
}

void LiveTracking::Search(TrackedFrame& tracked) {
    CameraSearch& search = state_->search;
    if (loops_ != nullptr && state_->seeking) {
        const CameraSearch::Step step = search.AfterTracking(tracked, !state_->asked);
        links_.notices.Tell(step.note);
        if (step.lost && tracked.report.tracked())
            state_->life.stage().RejectPose(kPoseUnconfirmed, tracked);
        if (step.question != Question::kNone) Ask(tracked, step.question == Question::kSecondView);
    }
    search.TellWhereFound(tracked);
    if (tracked.report.tracked()) state_->looked_for = false;
}

void LiveTracking::Ask(const TrackedFrame& tracked, bool check) {
    auto copy = std::make_unique<PreparedFrame>(tracked.prepared);
    LoopThread::Question question{state_->version, tracked.report.stamp_s, std::move(copy)};
    if (check) question.T_map_expected = tracked.report.track.T_world_camera;
    state_->asked = loops_->Ask(std::move(question));
}

}  // namespace tessera
