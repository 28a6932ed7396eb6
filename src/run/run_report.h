// JSON reports of a run: timings.json and run.json (docs/outputs.md lists the keys).
#pragma once

#include <string>

#include "run/run.h"

namespace tessera {

// The scan file that the run writes, as an absolute path, as in run.json; empty if none.
std::string ScanWrittenBy(const RunRequest& request);

// {"frames", "tracked", "wall_s", "cpu_s", "fps", "peak_rss_mb", "stages": {name: {"mean_ms",
// "median_ms", "p95_ms", "max_ms"}}, "map": {"blocks", "bytes", "bytes_per_voxel"}}
std::string TimingsJson(const RunSummary& summary);

// Version, command line, configuration, source, counts, how the run ended, and ATE if the source
// has ground truth.
std::string RunJson(const RunRequest& request, RunConfig config, const RunSummary& summary);

}  // namespace tessera
