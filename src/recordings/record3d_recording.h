// Reads recordings of the iPhone app Record3D (.r3d): a ZIP archive with a JPEG image, depth and
// the confidence of depth for each frame. The phone's own poses are not used. The format is known
// from github.com/marek-simonik/record3d, issues 7, 81, 93 and 108.
#pragma once

#include <string>

#include "recordings/recording.h"

namespace tessera {

// Frames without an image or without depth are left out, with a warning. Errors name the file.
RecordingResult OpenRecord3d(const std::string& path);

}  // namespace tessera
