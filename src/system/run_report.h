// What a run says of itself in JSON: timings.json and run.json (docs/outputs.md lists the keys).
#pragma once

#include <string>

#include "system/run.h"

namespace tessera {

// {"frames", "tracked", "wall_s", "cpu_s", "fps", "peak_rss_mb", "stages": {name: {"mean_ms",
// "median_ms", "p95_ms", "max_ms"}}, "map": {"blocks", "bytes", "bytes_per_voxel"}}
std::string TimingsJson(const RunSummary& summary);

// Command line, version, whole configuration, source, counts, how the run ended, ATE where the
// source has truth.
std::string RunJson(const RunRequest& request, RunConfig config, const RunSummary& summary);

}  // namespace tessera
