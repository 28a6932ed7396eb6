// run.json and timings.json of a run (docs/outputs.md lists their keys).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/status.h"

namespace tessera {

struct RunRecord {
    struct Camera {
        int width = 0, height = 0;
        double fx = 0, fy = 0, cx = 0, cy = 0;
    };
    struct Ate {
        double rmse_m = 0, mean_m = 0, median_m = 0, max_m = 0;
        std::int64_t pairs = 0;
    };

    std::string version, exit;
    std::string source_name, source_kind;
    std::optional<Camera> camera;
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
