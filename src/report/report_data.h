// What the page of a run shows: the files of its folder, read into one struct.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/se3.h"
#include "core/status.h"
#include "eval/ate.h"
#include "eval/rpe.h"
#include "report/frames_table.h"
#include "report/run_record.h"
#include "semantics/map_object.h"

namespace tessera {

// A setting as this program knows it.
struct KnownSetting {
    std::string key, unit, default_value;
};

struct ReportOptions {
    // Trajectory with the true path. Empty: groundtruth.txt in the run's folder, else the ground
    // truth of the source, if that is a folder that is still there.
    std::string truth;
    std::vector<KnownSetting> settings;  // to find those that differ; empty: that part is left out
    std::string version;                 // of this program
    std::size_t most_triangles = 1'500'000;
};

struct ReportData {
    std::string folder;
    std::optional<TriangleMesh> mesh;
    std::vector<StampedPose> path;          // T_world_camera; may be empty
    std::vector<StampedPose> tracked_path;  // before its correction; empty if it was not corrected
    std::optional<FramesTable> frames;
    std::optional<RunRecord> record;
    std::optional<RunTimes> times;
    std::vector<MapObject> objects;
    std::optional<AteResult> ate;
    std::optional<RpeResult> rpe;
    std::string truth;  // the file or folder that the errors come from

    std::vector<std::string> left_out;  // one line for each part that the run does not have
    std::vector<std::string> damaged;   // one line for each file that could not be read as a whole
};

// Only mesh.ply or trajectory.txt must be there. Errors: neither can be read, or options.truth
// cannot be used.
Result<ReportData> ReadReportData(const std::string& folder, const ReportOptions& options);

}  // namespace tessera
