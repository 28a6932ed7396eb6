// Finishes the model of a scan file or of a run's folder.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "core/status.h"
#include "finish/finish.h"

namespace tessera {

struct FinishRequest {
    std::string input;  // a scan file that holds its raw frames, or the folder of a run
    // Where the frames of a run come from, if its source has moved; "": the name in run.json.
    std::string source = {};
    bool level = false;  // z up and the floor at z = 0 (export/level.h)
    // Only what lies in this box, in the level world with `level`.
    std::optional<Eigen::AlignedBox3d> box_m = {};
    FinishOptions options = {};
};

// Frames are read on a thread of their own. Errors name the file and what to do.
Result<FinishedModel> FinishRun(const FinishRequest& request, const FinishProgress& progress);

}  // namespace tessera
