// frames.csv of a run: what happened to each frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

enum class FrameState { kFused, kTracked, kLost };  // kTracked: a pose, but not fused

struct FrameRow {
    std::int64_t index = 0;  // in the recording
    double stamp_s = 0;
    FrameState state = FrameState::kLost;
    bool degenerate = false;
    double inlier_fraction = 0;
    double distance_rms_m = 0;  // 0 in a file without it
    // Of the stages in their order, and of the whole frame, waiting for its decoding included.
    double decode_ms = 0;  // 0 in a file without it
    double prepare_ms = 0, track_ms = 0, moving_ms = 0, allocate_ms = 0, fuse_ms = 0, frame_ms = 0;
    std::string method, reason;  // reason: of a frame that is lost or poor
};

struct FramesTable {
    std::vector<FrameRow> rows;
    std::string damage;  // which lines were left out and why; empty if none
};

// Columns are found by their names, so files with more or other columns are read, too. A line that
// is not as the header says is left out. Error if the file has no such header.
Result<FramesTable> ReadFramesTable(const std::string& path);

}  // namespace tessera
