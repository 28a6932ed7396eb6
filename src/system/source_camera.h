// Opens a run's source with the camera that its own images show, where that is not the one that was
// given.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/status.h"
#include "io/frame_source.h"
#include "optimize/camera_estimate.h"
#include "system/run.h"

namespace tessera {

struct CheckedSource {
    std::unique_ptr<FrameSource> source;  // with the camera that is to be used, at its beginning
    std::optional<CameraReport> camera;   // where it was looked for and found
    std::vector<std::string> messages;    // for a person
};

// Recordings only: a device's first frames are the run's, a built-in scene's camera is exact, a
// scan keeps the camera that it was made with. Looks at the first seconds of the selection, at most
// twice: again with the camera that was found, through its own lens. Errors are OpenSource's.
Result<CheckedSource> OpenCheckedSource(const RunRequest& request, const RunConfig& config);

}  // namespace tessera
