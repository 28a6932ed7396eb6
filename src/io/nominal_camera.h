// Assumptions for an unknown camera, based on typical values and on the images themselves.
#pragma once

#include "core/status.h"
#include "io/folder_layout.h"

namespace tessera {

// What NominalPinhole assumes, for messages.
inline constexpr const char* kNominalCamera = "a field of view of 60 degrees";

// A horizontal field of view of 60 degrees and a centred principal point.
PinholeCamera NominalPinhole(int width, int height);

// Fills in the calibration of a layout with an unknown camera. Assumes a horizontal field of view
// of 60 degrees, a centred principal point, no distortion, and the depth unit (1000 or 5000 values
// per metre) that makes the median depth typical of a room. The depth unit is reported in the
// notes, unless the user has set it. The size is that of the first readable depth image; it is an
// error if there is none.
Status AssumeCamera(FolderLayout& layout, bool depth_scale_set);

// Returns `values` with the image size of `sized`.
PinholeCamera WithSizeOf(const PinholeCamera& sized, const PinholeCamera& values);

}  // namespace tessera
