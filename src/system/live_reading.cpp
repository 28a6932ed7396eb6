#include "system/live_reading.h"

#include <algorithm>
#include <thread>

#include "core/stopwatch.h"

namespace tessera {
namespace {

double SecondsOf(LiveClock::time_point time) {
    return std::chrono::duration<double>(time.time_since_epoch()).count();
}

}  // namespace

void WaitFor(double ms) {
    if (ms > 0) std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms));
}

LiveReading::LiveReading(EngineInput& input, LiveLinks& links)
    : links_(links),
      viewer_(input.viewer),
      stop_(*input.stop),
      frames_(std::move(input.source), input.selection),
      source_(frames_.info()),
      control_(input.viewer),
      playback_(input.config.live.playback_speed),
      recorder_(source_, input.config.record, false, links.notices) {
    if (input.scan.only_localise()) control_.KeepMap(links.notices);
}

Status LiveReading::StartRecording(const std::string& path) {
    return recorder_.Start(path, frames_.source());
}

void LiveReading::Run(LiveTracking& tracking) {
    while (GoesOn() && ReadFrame(tracking)) TakeCommands(tracking);
    recorder_.Stop();
}

void LiveReading::TakeCommands(LiveTracking& tracking) {
    while (const auto command = control_.TakeCommand()) Execute(*command, tracking);
    if (viewer_ != nullptr) viewer_->recording.store(recorder_.recording());
    stopped_ = stopped_ || stop_.load() || asked_to_stop_.load();
}

// Reads once from the source. Returns false at its end. While paused, a live camera's frames are
// read and discarded; a recording waits.
bool LiveReading::ReadFrame(LiveTracking& tracking) {
    using Kind = FrameOutcome::Kind;
    if (control_.waiting() && !source_.live) {
        RunControl::SleepBriefly();
        playback_.Restart();
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
            if (!source_.live) WaitUntilDue(item.frame->stamp_s, tracking);
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

// Waits until a recorded frame is due, and until the user lets it pass.
void LiveReading::WaitUntilDue(double stamp_s, LiveTracking& tracking) {
    constexpr double kSlice_s = 0.1;  // a stop is not delayed by more
    for (double wait_s = playback_.Wait_s(stamp_s, SecondsOf(LiveClock::now()));
         wait_s > 0 && GoesOn(); wait_s -= kSlice_s) {
        WaitFor(1000 * std::min(wait_s, kSlice_s));
        TakeCommands(tracking);
    }
    while (control_.waiting() && GoesOn()) {
        RunControl::SleepBriefly();
        playback_.Restart();
        TakeCommands(tracking);
    }
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
