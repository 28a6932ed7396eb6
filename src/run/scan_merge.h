// Merges two scans that overlap into a new one: `tessera scan merge`.
#pragma once

#include <string>

#include "core/status.h"

namespace tessera {

struct MergeReport {
    int places = 0;     // keyframes of the second scan that were found in the first
    int keyframes = 0;  // of both
    int overlaps = 0;   // alignments between keyframes of the one and of the other
    std::int64_t blocks = 0, frames = 0;  // of the new map and path
};

// The world is the first scan's. The map is made again from both scans' stored frames, at the poses
// that fit all overlaps. The two files are only read. `out` must not exist; it appears complete or
// not at all. Errors: scans of different cameras, voxels or without loop closure, scans with
// labels, and scans in which no common place was found.
Result<MergeReport> MergeScans(const std::string& first, const std::string& second,
                               const std::string& out);

}  // namespace tessera
