// Calibrations that public data sets publish with their images. config/cameras/*.yaml holds the
// same values, for users to copy; a test keeps the two in sync.
#pragma once

#include <optional>
#include <string_view>

#include "core/camera.h"

namespace tessera {

// "freiburg1", "freiburg2", "freiburg3" for TUM RGB-D (freiburg3 is the ROS default calibration of
// its colour camera, to which depth is registered); "icl_nuim"; "seven_scenes" (nominal values;
// how its two cameras stand to each other is not published, and taken from another Kinect).
// nullopt for other names.
std::optional<CameraCalibration> PublishedCamera(std::string_view name);

}  // namespace tessera
