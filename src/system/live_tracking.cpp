// LiveEngine's tracking thread: takes new frames and map updates, sends tasks.
#include "core/stopwatch.h"
#include "system/live_engine.h"

namespace tessera {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

}  // namespace

void LiveEngine::TrackFrames() {
    TrackingState state(config_, source_.camera, device_);
    if (loops_) state.stage.KeepImages();
    gate_.Begin(saved_tracking_, saved_pose_, loops_ == nullptr, state.stage);
    if (saved_stamp_s_) state.lost.Resume(*saved_stamp_s_);
    while (true) {
        tracking_wake_.Wait([&] {
            return !commands_.empty() || !new_frames_.empty() || reading_done_.load() ||
                   (device_ != nullptr && HasAnswers());
        });
        if (device_ != nullptr) MapNext();
        ViewerCommand command;
        NewFrame item;
        if (commands_.TryPop(command)) {
            if (command.kind == ViewerCommand::Kind::kReset) ResetTracking(state);
            Task task;
            task.command = command;
            SendTask(std::move(task));
        } else if (new_frames_.TryPop(item)) {
            TrackFrame(std::move(item), state);
        } else if (reading_done_.load() && new_frames_.empty() && commands_.empty()) {
            break;
        }
    }
    tracking_done_.store(true);
    if (device_ != nullptr) return EndMapping();
    mapping_wake_.Notify();
}

void LiveEngine::ResetTracking(TrackingState& state) {
    state.version = {state.version.world + 1, 0};
    state.stage.Reset();
    gate_.Open();
    state.field->Clear();
    state.lost = LostCamera(config_.loops, config_.pipeline.motion.max_gap_s);
}

void LiveEngine::TrackFrame(NewFrame item, TrackingState& state) {
    ViewerSettings settings;
    if (viewer_ != nullptr && viewer_->settings.TryPop(settings)) {
        state.stage.Apply(settings);
        show_prediction_.store(settings.show_prediction);
    }
    ApplyMapUpdates(state);
    TakeHint(state);
    Task task;
    task.tracked = tracked_pool_.Take();
    if (loops_) task.T_found_camera = TakeRelocalisation(item.frame->stamp_s, state);
    plan_.Select(*item.frame, state.stage);
    plan_.Track(*item.frame, MapToTrackIn(state), state.stage, *task.tracked);
    gate_.AfterTracking(*item.frame, state.stage, *task.tracked);
    if (loops_) CheckIfLost(*task.tracked, state);
    SaveTracking(state.stage, *task.tracked);
    WaitFor(config_.live.extra_tracking_ms);
    task.frame = std::move(item.frame);
    task.decode_ms = item.decode_ms;
    task.latency_ms = Milliseconds(Clock::now() - item.arrival).count();
    task.corrections = state.version.corrections;
    const bool first = task.tracked->report.first;
    SendTask(std::move(task));
    // The next frame needs a map.
    if (first && device_ == nullptr) tracking_wake_.Wait([&] { return !map_updates_.empty(); });
}

const BlockMap& LiveEngine::MapToTrackIn(const TrackingState& state) const {
    if (device_ == nullptr) return *state.field;
    return state.stage.reads_map() ? mapping_.map() : mapping_.blocks();
}

// The state travels with its frame, so that a checkpoint after that frame contains it.
void LiveEngine::SaveTracking(const TrackingStage& stage, TrackedFrame& tracked) const {
    tracked.tracking_state.clear();
    if (!saving_.load()) return;
    StateWriter state(tracked.tracking_state);
    stage.SaveState(state);
}

void LiveEngine::ApplyMapUpdates(TrackingState& state) {
    MapUpdate news;
    while (map_updates_.TryPop(news)) {
        const bool ours = news.world == state.version.world;
        if (ours && news.field) {
            state.field = std::move(news.field);
            state.stage.Move(news.T_new_old);
            ++state.version.corrections;
        } else if (ours) {
            ApplyDelta(*news.delta, *state.field);
        }
        delta_pool_.Give(std::move(news.delta));
    }
}

void LiveEngine::TakeHint(TrackingState& state) {
    Hint hint;
    if (hints_.TryPop(hint) && hint.map == state.version)
        state.stage.HintMoving(hint.moving, hint.T_world_camera);
}

std::optional<Eigen::Isometry3d> LiveEngine::TakeRelocalisation(double stamp_s,
                                                                TrackingState& state) {
    LoopThread::Answer answer;
    if (!loops_->TryTake(answer)) return std::nullopt;
    state.asked = false;
    if (!answer.T_world_camera || answer.map != state.version) return std::nullopt;
    Report(FrameOutcome::Kind::kMessage, answer.note);
    state.stage.Relocate({answer.stamp_s, *answer.T_world_camera});
    state.lost.Seen(stamp_s);
    return answer.T_world_camera;
}

void LiveEngine::CheckIfLost(TrackedFrame& tracked, TrackingState& state) {
    if (state.lost.Judge(tracked) != LostCamera::Verdict::kLost) return;
    if (tracked.report.tracked()) state.stage.RejectPose(kPoseUnconfirmed, tracked);
    if (state.asked || tracked.prepared.valid_depth_pixels == 0) return;
    auto copy = std::make_unique<PreparedFrame>(tracked.prepared);
    state.asked = loops_->Ask({state.version, tracked.report.stamp_s, std::move(copy)});
}

// Waits if mapping is far behind. Mapping then skips fusion until it has caught up.
void LiveEngine::SendTask(Task task) {
    tracking_wake_.Wait([&] { return tasks_.TryPush(std::move(task)); });
    if (device_ != nullptr) MapNext();
}

}  // namespace tessera
