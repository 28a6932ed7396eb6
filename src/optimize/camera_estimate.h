// What a recording says about its camera, how sure that is, and when it is to be believed.
#pragma once

#include <string>

#include "core/camera.h"

namespace tessera {

// Standard deviations hold what differs between parts of the recording (camera_fit.h), not the
// residuals' scatter.
struct CameraEstimate {
    PinholeCamera given, found;
    double focal_sigma_px = 0, centre_x_sigma_px = 0, centre_y_sigma_px = 0;
    // Of the colour image's rolling shutter, first row to last.
    double readout_s = 0, readout_sigma_s = 0;
    // Robust photometric error of a point, as given and as found.
    double misfit_given = 0, misfit_found = 0;
    int pairs = 0;  // of views that were compared

    // The recording contradicts what was given, by more than such an estimate can be wrong.
    bool focal_shown() const;
    bool centre_shown() const;
    bool shown() const { return focal_shown() || centre_shown(); }
    // The colour image's rows are not read out over so long.
    bool shutter_shown(double given_readout_s) const;
    // Good enough for a camera of which nothing is known.
    bool useful() const;
};

// For run.json: what was found, and what was done with it.
struct CameraReport {
    CameraEstimate estimate;
    bool known = true;  // the camera was given; else `estimate.given` is a guess
    bool used = false;
};

// The given camera with what was shown; all that was found where nothing was known.
PinholeCamera CameraToUse(const CameraEstimate& estimate, bool known);

// "camera.yaml says fx 615.0; this recording says 604.0 +- 2.0"; `who` says what was given.
std::string EstimateText(const CameraEstimate& estimate, const std::string& who);

}  // namespace tessera
