// The file "metadata" in a recording of the app Record3D: JSON with the camera and the times of
// frames.
#pragma once

#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/status.h"
#include "io/image_header.h"

namespace tessera {

struct Record3dMetadata {
    // The median of all frames' cameras, if it has them: the lens moves to steady the image. With
    // the size of images that the numbers are for.
    PinholeCamera colour_camera;
    ImageSize depth_size;          // 0 x 0: not said, as in older recordings
    double fps = 0;                // 0: not said
    std::vector<double> stamps_s;  // of frames, as they are; may be empty
};

// Errors say what is wrong, without the file's name. Thread-safe.
Result<Record3dMetadata> ParseRecord3dMetadata(std::string_view text);

}  // namespace tessera
