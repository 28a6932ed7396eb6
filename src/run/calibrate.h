// Calibrates the camera of a source that shows a printed board (tessera calibrate).
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "run/camera_calibrator.h"
#include "system/run_config.h"

namespace tessera {

struct CalibrateRequest {
    std::string source;
    CalibrationBoard board;
    const std::atomic<bool>* stop = nullptr;  // ends the reading; what was seen counts
    // Called after each kept view.
    std::function<void(const CameraCalibrator&)> on_view;
};

struct Calibrated {
    CalibrationResult result;
    std::string file;  // where the camera's calibration is looked for; "": nowhere
};

// Reads a recording to its end, a camera until it has seen enough. Lens correction is off. Errors:
// those of OpenSource, or too few views.
Result<Calibrated> CalibrateCamera(const CalibrateRequest& request, RunConfig config);

}  // namespace tessera
