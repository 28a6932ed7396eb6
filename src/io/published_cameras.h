// The calibrations that public data sets publish beside their images. The same values stand in
// config/cameras/*.yaml, for people to copy; a test holds the two together.
#pragma once

#include <optional>
#include <string_view>

#include "core/camera.h"

namespace tessera {

// TUM RGB-D: "freiburg1", "freiburg2", "freiburg3" (the ROS default calibration of its colour
// camera, to which depth is registered); "icl_nuim"; "seven_scenes". Nothing for other names.
std::optional<CameraCalibration> PublishedCamera(std::string_view name);

}  // namespace tessera
