// Result of self-calibration: for rebuilding the map, for the user, and for run.json.
#pragma once

#include <string>

#include "core/camera.h"

namespace tessera {

// Does not include a constant depth scale: no view can distinguish it from a world of a different
// size.
struct Calibration {
    double focal_scale = 1;  // true over given focal length, both axes
    // True depth = z / (1 + offset z). Models the disparity error of a triangulating sensor.
    double disparity_offset_per_m = 0;
};

struct CalibrationReport {
    bool shown = false;       // the data show an error, so `calibration` should be used
    Calibration calibration;  // the estimate, whether shown or not
    // Standard deviations; 0 for values that were held fixed.
    double focal_sigma = 0, offset_sigma_per_m = 0;
    // Robust distances of points from surfaces in other views.
    double rms_before_m = 0, rms_after_m = 0;
    int points = 0;  // number of points compared
};

// Returns the camera with the estimated focal lengths.
PinholeCamera Corrected(const PinholeCamera& camera, const Calibration& calibration);

// One line for the user: the estimate, and whether it is used. `offset_before_per_m`: from the
// configuration.
std::string CalibrationText(const PinholeCamera& camera, double offset_before_per_m,
                            const CalibrationReport& report);

}  // namespace tessera
