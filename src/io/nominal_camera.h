// A camera of which nobody says anything: what is usual, and what the images themselves show.
#pragma once

#include "core/status.h"
#include "io/folder_layout.h"

namespace tessera {

// Fills in the calibration of a layout whose camera is not known, and notes what is assumed: a
// horizontal field of view of 60 degrees, the centre in the middle, no distortion, and the unit of
// depth (1000 or 5000 values a metre) that makes the images' middle depth that of a room. The size
// is the first readable depth image's; an error if there is none.
Status AssumeCamera(FolderLayout& layout);

// `values`, with the size of `sized`.
PinholeCamera WithSizeOf(const PinholeCamera& sized, const PinholeCamera& values);

}  // namespace tessera
