// The tracking thread of a live run: takes new frames, commands and map updates; sends tasks to
// mapping.
#pragma once

#include "core/worker.h"
#include "system/camera_search.h"
#include "system/frame_tracking.h"
#include "system/live_links.h"
#include "system/live_mapping.h"

namespace tessera {

class LiveTracking {
  public:
    struct Settings {
        RunConfig config;
        PinholeCamera camera;
        Backend* device = nullptr;
        ViewerLink* viewer = nullptr;
        std::optional<TrackingResume> resume;
    };

    // Starts the thread. All that it refers to outlives it.
    LiveTracking(Settings settings, FramePlan plan, LiveLinks& links, LiveMapping& mapping);

    // ---- Reading thread.
    // Returns the frame dropped to make room, if any.
    std::optional<NewFrame> Push(NewFrame frame) { return worker_.PushNewest(std::move(frame)); }
    // Returns false if too many commands wait.
    bool Push(ViewerCommand command) { return commands_.TryPush(std::move(command)); }
    std::size_t waiting() const { return worker_.waiting(); }
    // Call after the last frame: tracks what waits, then lets mapping finish.
    void Finish() { worker_.Finish(); }

  private:
    // The thread's own: made and destroyed on it.
    struct State {
        State(const Settings& settings, FramePlan plan, std::unique_ptr<BlockMap> resumed_field);

        FrameTracking life;
        std::unique_ptr<BlockMap> field;  // copy of what tracking reads; unused with a device
        MapVersion version;               // of that copy
        CameraSearch search;
        bool seeking = true;  // loops are switched on
        bool asked = false;   // a relocalisation question is pending
        // An answer has come since the camera was last tracked. Until then no part begins, however
        // long that takes.
        bool looked_for = false;
        std::optional<LabelSettings> labels;  // new ones for mapping
        std::string detector;                 // chosen since the last task for mapping; else empty
        int detector_choice = 0;              // ViewerSettings::detector_choice
    };

    void TakeCommands();
    void Reset();
    void Track(NewFrame& item);
    const BlockMap& MapToTrackIn() const;
    void TakeSettings();
    bool ApplyMapUpdates();
    void TakeHint();
    std::optional<Eigen::Isometry3d> TakeRelocalisation(double stamp_s);
    void Search(TrackedFrame& tracked);
    void Ask(const TrackedFrame& tracked, bool check);

    const Settings settings_;
    FramePlan plan_;  // until the thread takes it
    LiveLinks& links_;
    LiveMapping& mapping_;
    LoopThread* const loops_;  // null without loop closure
    FifoQueue<ViewerCommand> commands_{16, links_.tracking};
    std::optional<State> state_;
    Worker<NewFrame, NewestQueue> worker_;
};

}  // namespace tessera
