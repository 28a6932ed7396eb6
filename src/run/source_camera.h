// Opens a run's source with the intrinsics, the registration, the delay and the vignetting of
// colour, and the errors of depth, estimated from its own images if they contradict the given ones.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/status.h"
#include "io/frame_source.h"
#include "run/run.h"

namespace tessera {

struct CheckedSource {
    std::unique_ptr<FrameSource> source;  // opened with the camera to use, at the first frame
    CameraFindings found;
    std::vector<std::string> messages;  // for the user
};

// Estimates the camera for recordings only: the first frames of a live camera belong to the run, a
// built-in scene's camera is exact, and a scan keeps the camera it was made with. Intrinsics of two
// cameras would need two estimates; of those only the registration and the time stamps are checked.
// Reads the first seconds of the selection, again with what was found, and then parts of all of it
// for the errors of depth. The source is opened again only where its settings change, or if it
// cannot seek. Errors are those of OpenSource.
Result<CheckedSource> OpenCheckedSource(const RunRequest& request, const RunConfig& config,
                                        const std::atomic<bool>* stop = nullptr);

}  // namespace tessera
