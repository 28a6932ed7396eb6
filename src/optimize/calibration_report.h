// What self-calibration found and whether it holds: for the map that is made again, for a person,
// and for run.json.
#pragma once

#include <string>

#include "core/camera.h"

namespace tessera {

// A depth that is too large or too small everywhere is no part of it: no view tells it from a world
// of another size.
struct Calibration {
    double focal_scale = 1;  // true focal length over the one that was given, both axes
    // True depth = z / (1 + offset z): a triangulating sensor's error of disparity.
    double disparity_offset_per_m = 0;
};

struct CalibrationReport {
    bool shown = false;       // the data show an error: `calibration` is to be used
    Calibration calibration;  // as estimated, shown or not
    // Standard deviations; 0 of what was held at the given value.
    double focal_sigma = 0, offset_sigma_per_m = 0;
    // Distances of points from surfaces in other views, robust.
    double rms_before_m = 0, rms_after_m = 0;
    int points = 0;  // compared
};

// The camera with the focal lengths that were found.
PinholeCamera Corrected(const PinholeCamera& camera, const Calibration& calibration);

// One line for a person: what was found, and that it is used, or why not. `offset_before_per_m`:
// the configuration's.
std::string CalibrationText(const PinholeCamera& camera, double offset_before_per_m,
                            const CalibrationReport& report);

}  // namespace tessera
