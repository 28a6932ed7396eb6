#include "optimize/camera_estimate.h"

#include <fmt/format.h>

#include <cmath>

namespace tessera {
namespace {

// On recordings with a known camera, estimates are off by up to five of their standard deviations,
// most of them by less than 1 % (docs/calibration.md). Errors that affect the whole recording do
// not show in its scatter.
constexpr double kDeviations = 6;
// The centre's standard deviation is three times too small there, the focal length's twice.
constexpr double kCentreDeviations = 12;
// Shares of the focal length and of the image width.
constexpr double kFocalFloor = 0.0125, kCentreFloor = 0.006;
// No calibration is this far off, as a share of the focal length. An estimate that is comes from a
// recording whose only texture is shading, which moves with the camera (a bare corner: 430 +- 1.8
// px for 525).
constexpr double kFocalCeiling = 0.1;
constexpr double kReadoutFloor_s = 0.002;    // at 1 rad/s half a pixel at the image border
constexpr double kShortestReadout_s = 0.01;  // of a sensor that is read row by row
constexpr double kVignettingFloor = 0.03;    // twice what intensities err by as it is
constexpr double kLeastVignetting = -0.3, kMostVignetting = 0.7;
constexpr double kUsefulFocal = 0.02;  // largest sigma, as a share of the focal length

bool Beyond(double difference, double sigma, double floor, double deviations = kDeviations) {
    return sigma > 0 && std::abs(difference) > std::max(deviations * sigma, floor);
}

}  // namespace

bool CameraEstimate::focal_shown() const {
    return misfit_found < misfit_given &&
           Beyond(found.fx - given.fx, focal_sigma_px, kFocalFloor * given.fx);
}

bool CameraEstimate::shown() const { return plausible() && (focal_shown() || centre_shown()); }

bool CameraEstimate::plausible() const {
    return std::abs(found.fx - given.fx) < kFocalCeiling * given.fx;
}

bool CameraEstimate::vignetting_shown() const {
    return Beyond(vignetting, vignetting_sigma, kVignettingFloor) &&
           vignetting > kLeastVignetting && vignetting < kMostVignetting;
}

bool CameraEstimate::vignetting_known(double share) const {
    return vignetting_sigma > 0 && kDeviations * vignetting_sigma < share;
}

bool CameraEstimate::centre_shown() const {
    const double floor_px = kCentreFloor * given.width;
    return misfit_found < misfit_given &&
           (Beyond(found.cx - given.cx, centre_x_sigma_px, floor_px, kCentreDeviations) ||
            Beyond(found.cy - given.cy, centre_y_sigma_px, floor_px, kCentreDeviations));
}

bool CameraEstimate::shutter_shown(double given_readout_s) const {
    return Beyond(readout_s - given_readout_s, readout_sigma_s, kReadoutFloor_s);
}

std::optional<double> CameraEstimate::certain_readout_s(double given_readout_s) const {
    if (shutter_shown(given_readout_s)) return readout_s;
    if (given_readout_s != 0) return given_readout_s;
    const bool certain = readout_sigma_s > 0 && kDeviations * readout_sigma_s < kShortestReadout_s;
    return certain ? std::optional(0.0) : std::nullopt;
}

bool CameraEstimate::useful() const {
    return focal_sigma_px > 0 && focal_sigma_px < kUsefulFocal * found.fx;
}

PinholeCamera CameraToUse(const CameraEstimate& estimate, bool known) {
    PinholeCamera camera = estimate.given;
    if (known ? estimate.focal_shown() : estimate.useful()) {
        camera.fx = estimate.found.fx;
        camera.fy = estimate.found.fy;
    }
    if (estimate.centre_shown()) {
        camera.cx = estimate.found.cx;
        camera.cy = estimate.found.cy;
    }
    return camera;
}

std::string EstimateText(const CameraEstimate& estimate, const std::string& who) {
    const PinholeCamera &given = estimate.given, &found = estimate.found;
    std::string text = fmt::format("{} says fx {:.1f}; this recording says {:.1f} +- {:.1f}", who,
                                   given.fx, found.fx, estimate.focal_sigma_px);
    if (estimate.centre_shown())
        text += fmt::format(
            ", and a centre of ({:.1f} +- {:.1f}, {:.1f} +- {:.1f}), not ({:.1f}, {:.1f})",
            found.cx, estimate.centre_x_sigma_px, found.cy, estimate.centre_y_sigma_px, given.cx,
            given.cy);
    return text;
}

}  // namespace tessera
