// The cameras of an Azure Kinect recording, from the calibration attached to it.
#pragma once

#include "core/input_file.h"
#include "io/image_header.h"
#include "recordings/mkv_index.h"
#include "recordings/recording.h"

namespace tessera {

// Fills in the cameras for images of these sizes; `colour` is zero without colour. Without a usable
// calibration, that of a usual device, and a note. An error if no mode of the camera has these
// sizes, without the file's name.
Status SetMkvCameras(const InputFile& file, const MkvIndex& index, ImageSize depth,
                     ImageSize colour, RecordingInfo& info);

}  // namespace tessera
