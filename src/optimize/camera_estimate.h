// Estimate of the camera intrinsics from a recording, its uncertainty, and when to trust it.
#pragma once

#include <optional>
#include <string>

#include "core/camera.h"

namespace tessera {

// Standard deviations come from the differences between parts of the recording (camera_fit.h), not
// from the scatter of the residuals.
struct CameraEstimate {
    PinholeCamera given, found;
    double focal_sigma_px = 0, centre_x_sigma_px = 0, centre_y_sigma_px = 0;
    // Read-out time of the colour image's rolling shutter, first row to last.
    double readout_s = 0, readout_sigma_s = 0;
    // Share of the brightness that is lost in the image's corners; it grows with the square of the
    // distance from the image's centre. Negative: the corners are too bright.
    double vignetting = 0, vignetting_sigma = 0;
    // Robust photometric error per point, with the given and with the estimated camera.
    double misfit_given = 0, misfit_found = 0;
    int pairs = 0;  // number of compared view pairs

    // True if the recording contradicts the given values by more than such an estimate can be
    // wrong.
    bool focal_shown() const;
    bool centre_shown() const;
    // True if one of them is, unless the focal length is too far off to be believed.
    bool shown() const;
    // False: the focal length is that far off.
    bool plausible() const;
    // Where no camera was given, none is too far off.
    bool believed(bool camera_known) const { return plausible() || !camera_known; }
    // True if the corners are clearly darker or brighter.
    bool vignetting_shown() const;
    // True if none of this size could go unseen.
    bool vignetting_known(double share) const;
    // True if the read-out time differs from the given one. Check first that the focal length is
    // plausible, if one was given: a fit that went astray has a wrong read-out time, too.
    bool shutter_shown(double given_readout_s) const;
    // The read-out time: the given one unless another shows. Nothing if none is given, none shows
    // and the estimate is too uncertain to say that it is 0.
    std::optional<double> certain_readout_s(double given_readout_s) const;
    // True if the estimate is good enough to use when nothing is known about the camera.
    bool useful() const;
};

// For run.json: the estimate and what was done with it.
struct CameraReport {
    CameraEstimate estimate;
    bool known = true;  // false: the camera was not given, `estimate.given` is a guess
    bool used = false;
};

// For run.json: how much darker the corners are.
struct VignettingReport {
    double share = 0, sigma = 0;
    bool used = false;
};

// Returns the given camera corrected where the recording contradicts it. If the camera is not
// known, takes the estimated focal length whenever it is useful().
PinholeCamera CameraToUse(const CameraEstimate& estimate, bool known);

// "camera.yaml says fx 615.0; this recording says 604.0 +- 2.0". `who` names the origin of the
// given values.
std::string EstimateText(const CameraEstimate& estimate, const std::string& who);

}  // namespace tessera
