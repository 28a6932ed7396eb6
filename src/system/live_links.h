// What the threads of a live run hand to each other. docs/threads.md lists the capacity and policy
// of every queue.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/notices.h"
#include "core/pool.h"
#include "core/queue.h"
#include "mapping/map_delta.h"
#include "mapping/moving_mask.h"
#include "system/engine.h"
#include "system/map_version.h"
#include "system/viewer_link.h"

namespace tessera {

using LiveClock = std::chrono::steady_clock;

// Reading to tracking.
struct NewFrame {
    std::unique_ptr<Frame> frame;
    double decode_ms = 0;
    LiveClock::time_point arrival;
};

// Tracking to mapping: a tracked frame, or a command if `tracked` is null.
struct MappingTask {
    std::unique_ptr<TrackedFrame> tracked;
    std::unique_ptr<Frame> frame;
    double decode_ms = 0, latency_ms = 0;
    int corrections = 0;  // number of corrections of the map it was tracked in
    // Pose at which a lost camera was relocalised, in that map.
    std::optional<Eigen::Isometry3d> T_found_camera;
    std::optional<LabelSettings> labels;  // if they changed
    std::string detector;                 // one was chosen; else empty
    ViewerCommand command;
};

// Mapping to tracking: the blocks that a fused frame changed, or the whole field of a corrected
// map, then with what has changed in it since. `world` is the number of resets before it.
struct MapUpdate {
    std::unique_ptr<MapDelta> delta;
    int world = 0;
    std::unique_ptr<BlockMap> field;
    Eigen::Isometry3d T_new_old = Eigen::Isometry3d::Identity();  // with `field`
    bool first = false;  // answers the first frame of a part, fused or not
};

// Mapping to tracking: what a detector reports as movable, in a frame that was tracked in that map.
struct LiveHint {
    MovingHint moving;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    MapVersion map;
};

struct LiveLinks {
    static constexpr std::size_t kTasks = 8, kOutcomes = 4096;
    // Frames that mapping may answer beside those that wait: the one in its hands, and the one that
    // tracking passes on.
    static constexpr std::size_t kInHand = 2;
    // Corrected maps on their way to tracking: another is passed on only while fewer updates wait.
    static constexpr std::size_t kCorrections = 3;

    // With a device the tracking thread also maps, so both sleep on one Wake. Else mapping sleeps
    // on that of the window's system, if there is one, which outlives the object.
    LiveLinks(bool one_thread, Notices& run_notices, Wake& owner, ViewerLink* viewer = nullptr)
        : mapping(one_thread          ? tracking
                  : viewer != nullptr ? viewer->system
                                      : own_mapping),
          notices(run_notices),
          outcomes(kOutcomes, owner) {}

    void Report(FrameOutcome::Kind kind, const std::string& message) {
        FrameOutcome outcome;
        outcome.kind = kind;
        outcome.message = message;
        outcomes.Push(std::move(outcome));
    }

    Wake tracking, own_mapping;
    Wake& mapping;
    Notices& notices;
    NewestQueue<FrameOutcome> outcomes;  // all threads to the owner
    FifoQueue<MapUpdate> map_updates{kTasks + kInHand + kCorrections, tracking};
    NewestQueue<LiveHint> hints{1, tracking};

    Pool<Frame> frames;
    Pool<TrackedFrame> tracked_frames;
    Pool<MapDelta> deltas;

    std::atomic<bool> quit{false};            // the run is abandoned
    std::atomic<bool> saving{false};          // a scan is being saved: tracking saves its state
    std::atomic<bool> show_prediction{true};  // in the window
    std::atomic<std::size_t> new_frames{0}, to_recorder{0};  // queue lengths, for the window
};

// Simulates a slow source or a slow stage. No wait if `ms` <= 0.
void WaitFor(double ms);

}  // namespace tessera
