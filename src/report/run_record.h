// run.json and timings.json of a run (docs/outputs.md lists their keys).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/depth_distortion.h"
#include "core/status.h"

namespace tessera {

struct RunRecord {
    struct Ate {
        double rmse_m = 0, mean_m = 0, median_m = 0, max_m = 0;
        std::int64_t pairs = 0;
    };

    std::string version, exit;
    std::string source_name, source_kind;
    std::string scan;                     // the scan file that it wrote, an absolute path
    std::optional<PinholeCamera> camera;  // as used; empty if it is not plausible
    double vignetting = 0;                // as corrected; 0: not
    double colour_delay_s = 0;            // the source's setting and what was found beyond it
    double depth_readout_s = 0, colour_readout_s = 0;  // with which tracking began
    std::array<double, 2> colour_shift_px = {0, 0};    // as corrected; right and down; 0: not
    DepthDistortion depth_distortion;                  // as corrected; empty: not
    double disparity_offset_per_m = 0;  // of the model: as set, or as calibration.refine found it
    // fx and fy of the model, where calibration.refine found others than the camera's.
    std::optional<std::array<double, 2>> refined_focal_px;
    bool has_truth = false;
    std::vector<std::string> command_line, warnings;
    std::vector<std::pair<std::string, std::int64_t>> counts;  // "frames", "tracked", "lost", ...
    std::optional<Ate> ate;
    // Every setting with its value as text, in the file's order.
    std::vector<std::pair<std::string, std::string>> configuration;

    // nullopt if the file does not have it.
    std::optional<std::int64_t> Count(const std::string& name) const;
};

struct RunTimes {
    struct Stage {
        std::string name;
        double mean_ms = 0, median_ms = 0, p95_ms = 0, max_ms = 0;
    };
    double wall_s = 0, fps = 0, peak_rss_mb = 0;
    double map_mb = 0;
    std::vector<Stage> stages;
};

// A key that is missing keeps its default. Errors: no file, or not such a file; the message names
// it.
Result<RunRecord> ReadRunRecord(const std::string& path);
Result<RunTimes> ReadRunTimes(const std::string& path);

}  // namespace tessera
