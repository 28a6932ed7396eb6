// Everything that passes between a running system and the viewer window: data to show goes out,
// commands come in. Values over bounded queues. Neither side waits for the other, and either may be
// absent.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/frame.h"
#include "core/queue.h"
#include "mapping/predicted_view.h"
#include "semantics/detector.h"
#include "semantics/map_object.h"
#include "system/mapping_stage.h"
#include "system/tracking_stage.h"
#include "system/viewer_settings.h"

namespace tessera {

// Frames since the start or the last reset.
struct RunCounts {
    std::int64_t frames = 0;   // read, including skipped frames
    std::int64_t tracked = 0;  // with a pose: lines of the trajectory
    std::int64_t fused = 0;
    std::int64_t poor = 0;        // tracked, but not well enough to fuse
    std::int64_t lost = 0;        // no pose
    std::int64_t skipped = 0;     // could not be read
    std::int64_t dropped = 0;     // live: a newer frame arrived before this one was tracked
    std::int64_t unfused = 0;     // live: tracked well, but mapping was busy
    std::int64_t degenerate = 0;  // the scene left some motion unconstrained
};

// The numbers of one frame.
struct FrameUpdate {
    FrameReport report;
    std::optional<Eigen::Isometry3d> T_world_camera_truth;  // in the map's world
    // Latency: from the frame's arrival to its pose.
    double decode_ms = 0, mesh_ms = 0, latency_ms = 0;
    RunCounts counts;                                         // up to and including this frame
    std::vector<std::pair<const char*, std::size_t>> queues;  // queue name and length
    MapStatistics map;
};

// Images of one frame. Large, so only the newest is kept.
struct ImageUpdate {
    std::shared_ptr<const Frame> frame;        // never null
    std::shared_ptr<const MovingMask> moving;  // null: nothing moves
    // The map seen from the frame's pose, at lower resolution. Null unless requested.
    std::shared_ptr<const PredictedView> predicted;
};

// The detector's result for one frame.
struct LabelUpdate {
    struct Shown {
        DetectionBox box;  // pixels of the frame's colour image
        std::string name;
        float probability = 0;
        Rgb8 colour;  // of its class
    };
    double stamp_s = 0;  // of the frame
    double detect_ms = 0;
    std::vector<Shown> detections;
    // The detector failed and labelling has ended; a message gives the reason.
    bool stopped = false;
};

// One user command.
struct ViewerCommand {
    enum class Kind {
        kPause,  // no further frames until kResume
        kResume,
        kStep,      // one frame, then pause
        kReset,     // clear the map and the trajectory; the next frame starts a new world
        kSaveMesh,  // to `path` (.ply)
        kSaveScan,  // to `path` (.scan): everything so far, then continuously
        kRecord,    // record the raw frames from now on, to `path`
        kStopRecording,
        kStop,  // end the run and save everything
    };
    Kind kind = Kind::kPause;
    std::string path = {};
};

// Created by the program. Shared by the system's threads and the viewer's.
struct ViewerLink {
    // Each side sleeps on its own. The system's is notified of settings and commands, of a pause
    // and of meshes that were taken.
    Wake viewer, system;

    // System to viewer. One thread pushes frames and messages.
    NewestQueue<FrameUpdate> frames{256, viewer};
    NewestQueue<ImageUpdate> images{1, viewer};
    // By the map's owner, which is the run's thread at the end. If full, changes stay in the
    // mesher.
    FifoQueue<MeshUpdate> meshes{4, viewer};
    // Pushed by the thread that pushes frames.
    NewestQueue<LabelUpdate> labels{64, viewer};
    NewestQueue<LabelClasses> classes{1, viewer};   // of a run with labels, at its start
    NewestQueue<std::string> detectors{1, viewer};  // names of those chosen that came into use
    // All objects, by number. Pushed by the map's owner; at the end, by the thread that pushes
    // frames.
    NewestQueue<std::vector<MapObject>> objects{1, viewer};
    NewestQueue<std::string> messages{64, viewer};  // same text as on the console
    std::atomic<bool> ended{false};                 // the run is over and its files are written
    std::atomic<bool> keeps_map{false};             // it is over, and its map can still be saved
    std::atomic<bool> paused{false}, recording{false};  // the state of the system

    // Viewer to system.
    std::atomic<bool> open{false};  // a window is open, or will be: the run waits for it at its end
    NewestQueue<ViewerSettings> settings{1, system};  // all settings at once
    NewestQueue<ViewerCommand> commands{64, system};
};

}  // namespace tessera
