// The calibrations of a user's own cameras, by serial number.
#pragma once

#include <optional>
#include <string>

#include "core/camera.h"

namespace tessera {

// $XDG_CONFIG_HOME/tessera/cameras/SERIAL.yaml, or the same in ~/.config; "" without a serial
// number or a home. Characters that are no letters or digits become '_'.
std::string CalibrationPath(const std::string& serial);

struct StoredCalibration {
    std::string path;
    CameraCalibration calibration;
};

// The camera file `named`; if this is empty, the file at CalibrationPath, if there is one; nullopt
// if it is "none". An error if the file is bad or of another image size.
Result<std::optional<StoredCalibration>> FindCalibration(const std::string& named,
                                                         const std::string& serial, int width,
                                                         int height);

}  // namespace tessera
