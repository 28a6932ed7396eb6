// All that passes between a running system and a person's window: what there is to see goes out,
// what the person wants comes in. Values over bounded queues; neither side ever waits for the
// other, and either may be gone.
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
#include "system/run.h"
#include "system/tracking_stage.h"
#include "system/viewer_settings.h"

namespace tessera {

// One frame as far as numbers go.
struct FrameUpdate {
    FrameReport report;
    std::optional<Eigen::Isometry3d> T_world_camera_truth;  // in the map's world
    // Latency: from the frame's arrival to its pose.
    double decode_ms = 0, mesh_ms = 0, latency_ms = 0;
    RunCounts counts;                                         // up to and with this frame
    std::vector<std::pair<const char*, std::size_t>> queues;  // name and how many wait in it
    MapStatistics map;
    // By a live source so far, because newer ones came.
    std::int64_t dropped = 0;
};

// Pictures of one frame; large, so only the newest is kept.
struct ImageUpdate {
    std::shared_ptr<const Frame> frame;        // never null
    std::shared_ptr<const MovingMask> moving;  // null: nothing moves
    // The map from the frame's pose, smaller; null unless wanted.
    std::shared_ptr<const PredictedView> predicted;
};

// What the detector said of one frame.
struct LabelUpdate {
    struct Shown {
        DetectionBox box;  // pixels of the frame's colour image
        std::string name;
        float probability = 0;
        Rgb8 colour;  // of its class
    };
    double stamp_s = 0;  // the frame's
    double detect_ms = 0;
    std::vector<Shown> detections;
    bool stopped = false;  // the detector broke and labelling is over; a message says why
};

// What a person asks for once.
struct ViewerCommand {
    enum class Kind {
        kPause,  // no further frames until kResume
        kResume,
        kStep,      // one frame, then pause
        kReset,     // an empty map and trajectory; the next frame is the new world
        kSaveMesh,  // to `path` (.ply)
        kSaveScan,  // to `path` (.scan): all so far, and from now on as it goes
        kRecord,    // keep the raw frames from now on, in `path`
        kStopRecording,
        kStop,  // end the run, everything saved
    };
    Kind kind = Kind::kPause;
    std::string path;
};

// Made by the program, shared by the system's threads and the viewer's.
struct ViewerLink {
    Wake viewer, system;  // who sleeps on what

    // System to viewer. Frames and messages: one thread pushes.
    NewestQueue<FrameUpdate> frames{256, viewer};
    NewestQueue<ImageUpdate> images{1, viewer};
    FifoQueue<MeshUpdate> meshes{4, viewer};  // full: the changes wait at the mesher
    // The thread that pushes frames.
    NewestQueue<LabelUpdate> labels{64, viewer};
    // All that there are, by number: the map's owner; at the end the other.
    NewestQueue<std::vector<MapObject>> objects{1, viewer};
    NewestQueue<std::string> messages{64, viewer};      // as a person reads them on the console
    std::atomic<bool> ended{false};                     // the run is over and its files are written
    std::atomic<bool> paused{false}, recording{false};  // as the system has obeyed

    // Viewer to system.
    NewestQueue<ViewerSettings> settings{1, system};  // sent whole
    NewestQueue<ViewerCommand> commands{64, system};
};

}  // namespace tessera
