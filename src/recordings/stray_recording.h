// Reads folders of the app Stray Scanner: a colour video and, of each of its frames, depth and its
// confidence as images. The poses in odometry.csv are not used.
#pragma once

#include <string>

#include "recordings/recording.h"

namespace tessera {

// Whether the folder has rgb.mp4, camera_matrix.csv and depth/.
bool IsStrayFolder(const std::string& path);

// Depth image N belongs to frame N of the video. Depth of the lowest confidence is removed. Errors
// name the file.
RecordingResult OpenStrayRecording(const std::string& path);

}  // namespace tessera
