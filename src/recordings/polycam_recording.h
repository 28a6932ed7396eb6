// Reads raw exports of the app Polycam (github.com/PolyCam/polyform): keyframes with an image,
// depth, confidence and a camera each. The poses of the cameras are not used.
#pragma once

#include <string>

#include "recordings/recording.h"

namespace tessera {

// Whether the folder has keyframes/depth and keyframes/cameras or corrected_cameras.
bool IsPolycamFolder(const std::string& path);

// Takes the images as the phone recorded them, because depth is in register with these; if there
// are none, the corrected images. All keyframes get the first one's camera. Depth of the lowest
// confidence is removed. Errors name the file.
RecordingResult OpenPolycamRecording(const std::string& path);

}  // namespace tessera
