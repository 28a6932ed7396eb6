#include "system/live_reading.h"

#include <thread>

#include "core/stopwatch.h"

namespace tessera {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

}  // namespace

void WaitFor(double ms) {
    if (ms > 0) std::this_thread::sleep_for(Milliseconds(ms));
}

LiveReading::LiveReading(EngineInput& input, LiveLinks& links)
    : playback_speed_(input.config.live.playback_speed),
      links_(links),
      viewer_(input.viewer),
      stop_(*input.stop),
      frames_(std::move(input.source), input.selection),
      source_(frames_.info()),
      control_(input.viewer),
      recorder_(source_, input.config.record, false, links.notices) {
    if (input.scan.only_localise()) control_.KeepMap(links.notices);
}

Status LiveReading::StartRecording(const std::string& path) {
    return recorder_.Start(path, frames_.source());
}

void LiveReading::Run(LiveTracking& tracking) {
    while (!links_.quit.load() && !stopped_ && ReadFrame(tracking)) {
        while (const auto command = control_.TakeCommand()) Execute(*command, tracking);
        if (viewer_ != nullptr) viewer_->recording.store(recorder_.recording());
        stopped_ = stopped_ || stop_.load() || asked_to_stop_.load();
    }
    recorder_.Stop();
}

// Reads once from the source. Returns false at its end. While paused, a live camera's frames are
// read and discarded; a recording waits.
bool LiveReading::ReadFrame(LiveTracking& tracking) {
    using Kind = FrameOutcome::Kind;
    if (control_.waiting() && !source_.live) {
        RunControl::SleepBriefly();
        first_stamp_s_.reset();
        return true;
    }
    NewFrame item{links_.frames.Take(), 0, {}};
    Stopwatch watch;
    const ReadResult read = frames_.Next(*item.frame);
    item.decode_ms = watch.LapMs();
    switch (read.status) {
        case ReadStatus::kError: status_ = Status::Error(read.message); return false;
        case ReadStatus::kEnd: return false;
        case ReadStatus::kSkip: links_.Report(Kind::kSkipped, read.message); break;
        case ReadStatus::kWait: links_.notices.Tell(read.message); break;
        case ReadStatus::kOk:
            if (!source_.live) WaitUntilDue(item.frame->stamp_s);
            if (control_.TakeTurn()) Pass(std::move(item), tracking);
            break;
    }
    links_.frames.Give(std::move(item.frame));
    return true;
}

void LiveReading::Pass(NewFrame frame, LiveTracking& tracking) {
    recorder_.Add(*frame.frame);
    frame.arrival = LiveClock::now();
    if (auto dropped = tracking.Push(std::move(frame))) {
        links_.frames.Give(std::move(dropped->frame));
        links_.Report(FrameOutcome::Kind::kDropped, {});
    }
    links_.new_frames.store(tracking.waiting());
    links_.to_recorder.store(recorder_.waiting());
}

// Waits until a recorded frame is as long after the first frame as it was recorded.
void LiveReading::WaitUntilDue(double stamp_s) {
    constexpr double kAfterAll_s = 1.0;  // no waiting for longer gaps in the stamps
    const LiveClock::time_point now = LiveClock::now();
    if (first_stamp_s_) {
        const double wait_ms = 1000 * (stamp_s - *first_stamp_s_) / playback_speed_ -
                               Milliseconds(now - first_time_).count();
        if (std::abs(wait_ms) < 1000 * kAfterAll_s) return WaitFor(wait_ms);
    }
    first_stamp_s_ = stamp_s;
    first_time_ = now;
}

void LiveReading::Execute(const ViewerCommand& command, LiveTracking& tracking) {
    switch (command.kind) {
        case ViewerCommand::Kind::kStop: stopped_ = true; break;
        case ViewerCommand::Kind::kRecord:
            if (Status status = recorder_.Start(command.path); !status.ok())
                links_.notices.Tell(status.message());
            break;
        case ViewerCommand::Kind::kStopRecording: recorder_.Stop(); break;
        default:
            if (!tracking.Push(command))
                links_.notices.Tell("too many commands at once: one was ignored");
    }
}

}  // namespace tessera
