// Makes frames of a Recording: corrects the lens, brings colour into the depth camera's view, and
// puts depth into metres.
#pragma once

#include <memory>
#include <string>

#include "io/folder_source.h"
#include "io/frame_source.h"
#include "recordings/recording.h"

namespace tessera {

// The source can seek. A pair that cannot be loaded returns kSkip. `config.camera` replaces the
// depth camera's pinhole and, where colour has the same camera, the colour camera's too. Errors
// name the path: no pair at all, or the first ones cannot be loaded. `camera_file`: a camera.yaml
// for a recording that does not say its camera; "" if there is none.
Result<std::unique_ptr<FrameSource>> MakeRecordingSource(const std::string& path,
                                                         std::unique_ptr<Recording> recording,
                                                         const FolderSourceConfig& config,
                                                         const std::string& camera_file = {});

}  // namespace tessera
