// One whole run, from a source to a folder of results. All messages for the user go through the
// observer.
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
#include "optimize/colour_delay.h"
#include "optimize/colour_shift.h"
#include "optimize/depth_distortion_estimator.h"
#include "run/timings.h"
#include "semantics/map_object.h"
#include "system/frame_plan.h"
#include "system/run_config.h"
#include "system/viewer_link.h"

namespace tessera {

struct RunRequest {
    std::string source;
    // Live: the newest frame wins and each stage has its own thread. Else lockstep: every frame, in
    // order.
    bool live = false;
    // Records the raw frames: a folder, or FILE.oni of an OpenNI2 camera. Empty: no recording.
    std::string record_path;
    ViewerLink* viewer = nullptr;  // outlives the run
    FrameSelection selection;
    std::string labels;     // a network, a detections file, or "synthetic"; empty: no labels
    std::string scan_file;  // written during the run; empty: none
    bool resume = false;    // continue the existing scan_file; else create it
    // Track the camera in the existing scan_file, which is only read. Not with `resume`.
    bool localise_only = false;
    std::string poses_file;  // TUM trajectory: fuse at its poses, no tracking; empty: track
    std::vector<MethodSwitch> switches;     // for the same frame, the last one wins
    std::string output_folder;              // empty: no output and no mesh
    Backend* device = nullptr;              // null: CPU; outlives the run
    std::vector<std::string> command_line;  // as given, for run.json
};

struct LabelSummary {
    std::int64_t frames = 0;      // frames that the detector processed
    std::int64_t detections = 0;  // of wanted classes, above the probability threshold
    std::int64_t flips = 0;       // settled voxels that changed their class
    std::int64_t settled = 0;     // voxels that settled on an object's class
    std::vector<MapObject> objects;
};

// What a recording shows of its camera, with calibration.check; each only if it could be estimated.
struct CameraFindings {
    std::optional<CameraReport> camera;
    std::optional<VignettingReport> vignetting;
    std::optional<ColourShift> colour_shift;  // of colour against depth
    std::optional<ColourDelay> colour_delay;  // of its time stamps
    std::optional<DepthDistortionEstimate> depth_distortion;
};

struct RunSummary {
    SourceInfo source;
    RunCounts counts;
    // From the request of the first frame to the completion of the last. Excludes the final mesh
    // and files.
    double wall_s = 0, cpu_s = 0, fps = 0;
    double peak_rss_mb = 0;  // of the whole process, including the final mesh and its picture
    std::vector<std::pair<std::string, StageStatistics>> stages;
    MapStatistics map;
    std::optional<LabelSummary> labels;  // with labels only
    std::string detector;                // with labels: the last one in use, as for --labels
    // With calibration.refine, if there was enough data for an estimate.
    std::optional<CalibrationReport> calibration;
    CameraFindings found;
    // Read-out times of the images with which tracking began.
    double depth_readout_s = 0, colour_readout_s = 0;
    std::optional<AteResult> ate;  // against the source's ground truth; none with given poses
    std::string exit;              // "finished", "stopped", or "failed: ..."
    std::string last_reason;       // of the last lost frame
    bool stopped = false;          // on request
};

// Checks for options that exclude each other and for parts that this build lacks. The error says
// what to leave out or to install.
Status CheckRun(const RunRequest& request, const RunConfig& config);

// Called on the thread that calls ExecuteRun. Members may be empty.
struct RunObserver {
    std::function<void(const SourceInfo&)> on_open;
    std::function<void(const std::string&)> on_warning;
    std::function<void(const RunCounts&, std::int64_t total)> on_frame;  // total: -1 if unknown
};

// Errors: bad input, an output that cannot be written, or a source that failed. Files written by
// then are kept and are complete up to the last frame. Setting `stop` ends the run after the
// current frame, as if the source ended there.
Result<RunSummary> ExecuteRun(const RunRequest& request, const RunConfig& config,
                              const RunObserver& observer, const std::atomic<bool>& stop);

}  // namespace tessera
