// The camera file of recordings in Open3D's layout.
#pragma once

#include <optional>
#include <string>

#include "core/camera.h"

namespace tessera {

struct Open3dCamera {
    std::string file;  // its name within the folder
    CameraCalibration calibration;
};

// Reads intrinsic.json, camera_intrinsic.json or camera_primesense.json (width, height and
// intrinsic_matrix, column by column), as Open3D's recorders and examples write them. Depth is in
// millimetres. nullopt if there is none; an error that names the file if it is bad.
Result<std::optional<Open3dCamera>> ReadOpen3dCamera(const std::string& folder);

}  // namespace tessera
