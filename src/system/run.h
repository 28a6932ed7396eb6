// One whole run, from a source to a folder of results. No thread of its own but the source's
// reader; everything that a person is told goes through the observer.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/status.h"
#include "eval/ate.h"
#include "io/frame_source.h"
#include "optimize/calibration_report.h"
#include "optimize/camera_estimate.h"
#include "semantics/map_object.h"
#include "system/run_config.h"
#include "system/timings.h"

namespace tessera {

// From the first frame on whose index is not smaller.
struct MethodSwitch {
    std::int64_t frame = 0;
    TrackingMethod method = TrackingMethod::kSdf;
};

class Device;
struct ViewerLink;

struct RunRequest {
    std::string source;
    // The newest frame wins, stages on threads of their own; else lockstep: every frame, in order.
    bool live = false;
    // Keep the raw frames there: a folder, or FILE.oni of an OpenNI2 camera.
    std::string record_path;
    ViewerLink* viewer = nullptr;  // outlives the run
    FrameSelection selection;
    std::string labels;      // a network, a detections file, or "synthetic"; empty = no labels
    std::string scan_file;   // written as the run goes; empty = none
    bool resume = false;     // scan_file is there and gone on with; else it is made
    std::string poses_file;  // TUM trajectory: fuse at its poses and do not track; empty = track
    std::vector<MethodSwitch> switches;     // of one frame, the last counts
    std::string output_folder;              // empty = nothing is written and no mesh is made
    Device* device = nullptr;               // in the processor's place; outlives the run
    std::vector<std::string> command_line;  // as given, for run.json
};

struct RunCounts {
    std::int64_t frames = 0;   // read, the skipped ones included
    std::int64_t tracked = 0;  // with a pose: the trajectory's lines
    std::int64_t fused = 0;
    std::int64_t poor = 0;        // tracked, but too badly to be fused
    std::int64_t lost = 0;        // no pose
    std::int64_t skipped = 0;     // could not be read
    std::int64_t dropped = 0;     // live: a newer one came before it was tracked
    std::int64_t unfused = 0;     // live: tracked well, but mapping was busy
    std::int64_t degenerate = 0;  // the scene left some motion unconstrained
};

struct MapStatistics {
    std::int64_t blocks = 0;
    std::size_t bytes = 0;
    double bytes_per_voxel = 0;
};

MapStatistics StatisticsOf(const BlockMap& map);

struct LabelSummary {
    std::int64_t frames = 0;      // that were detected
    std::int64_t detections = 0;  // of wanted classes and enough probability
    std::int64_t flips = 0;       // settled voxels that changed their class
    std::int64_t settled = 0;     // voxels that settled on an object's class
    std::vector<MapObject> objects;
};

struct RunSummary {
    SourceInfo source;
    RunCounts counts;
    // From the first frame's request to the last frame's completion; the mesh and the files at the
    // end are not in it.
    double wall_s = 0, cpu_s = 0, fps = 0;
    double peak_rss_mb = 0;  // of the whole process, the mesh and its picture included
    std::vector<std::pair<std::string, StageStatistics>> stages;
    MapStatistics map;
    std::optional<LabelSummary> labels;  // with labels only
    // With calibration.refine, where enough was seen for an estimate.
    std::optional<CalibrationReport> calibration;
    // With calibration.check, of recordings that show their camera.
    std::optional<CameraReport> camera;
    std::optional<AteResult> ate;  // against the source's own truth; none at given poses
    std::string exit;              // "finished", "stopped", or "failed: ..."
    std::string last_reason;       // why the last lost frame was lost
    bool stopped = false;          // on request
};

// What cannot go together, or needs a part that this build lacks; the error says what to leave out
// or to install.
Status CheckRun(const RunRequest& request, const RunConfig& config);

// Called on the thread that runs. Members may be empty.
struct RunObserver {
    std::function<void(const SourceInfo&)> on_open;
    std::function<void(const std::string&)> on_warning;
    std::function<void(const RunCounts&, std::int64_t total)> on_frame;  // total: -1 if not known
};

// Errors: bad input, an output that cannot be written, or a source that broke; what was written by
// then stays and is complete up to the last frame. Setting `stop` ends the run after the present
// frame as if the source ended there.
Result<RunSummary> ExecuteRun(const RunRequest& request, const RunConfig& config,
                              const RunObserver& observer, const std::atomic<bool>& stop);

}  // namespace tessera
