// The reading thread of a live run: takes frames from the source as they come and the user's
// commands, and passes both on to tracking. The newest frame wins.
#pragma once

#include "io/selected_frames.h"
#include "system/live_links.h"
#include "system/live_tracking.h"
#include "system/playback_clock.h"
#include "system/recorder_thread.h"
#include "system/run_control.h"

namespace tessera {

class LiveReading {
  public:
    // All that it refers to outlives it.
    LiveReading(EngineInput& input, LiveLinks& links);

    const SourceInfo& source() const { return source_; }
    // Before Run: records to a folder or to FILE.oni.
    Status StartRecording(const std::string& path);

    // Runs on its thread to the end of the source, or until a stop is requested.
    void Run(LiveTracking& tracking);

    // After Run. An error of the source; `stopped`: on request, before the source ended.
    const Status& status() const { return status_; }
    bool stopped() const { return stopped_; }
    void Stop() { asked_to_stop_.store(true); }  // from any thread

  private:
    bool ReadFrame(LiveTracking& tracking);
    void Pass(NewFrame frame, LiveTracking& tracking);
    void Execute(const ViewerCommand& command, LiveTracking& tracking);
    void WaitUntilDue(double stamp_s, LiveTracking& tracking);
    void TakeCommands(LiveTracking& tracking);
    bool GoesOn() const { return !links_.quit.load() && !stopped_; }

    LiveLinks& links_;
    ViewerLink* const viewer_;
    const std::atomic<bool>& stop_;
    SelectedFrames frames_;
    const SourceInfo source_;
    RunControl control_;
    PlaybackClock playback_;
    RecorderThread recorder_;
    Status status_;
    bool stopped_ = false;
    std::atomic<bool> asked_to_stop_{false};
};

}  // namespace tessera
