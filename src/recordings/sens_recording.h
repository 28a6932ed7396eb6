// Reads ScanNet recordings (.sens, version 4): colour as JPEG, PNG or raw, depth as raw values or
// zlib. The poses that are stored with the frames are not used.
#pragma once

#include <string>

#include "recordings/recording.h"

namespace tessera {

// Frames that a truncated file lacks are a warning. Errors name the file.
RecordingResult OpenSensRecording(const std::string& path);

}  // namespace tessera
