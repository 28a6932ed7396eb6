#include "optimize/calibration_report.h"

#include <fmt/format.h>

namespace tessera {

PinholeCamera Corrected(const PinholeCamera& camera, const Calibration& calibration) {
    PinholeCamera corrected = camera;
    corrected.fx *= calibration.focal_scale;
    corrected.fy *= calibration.focal_scale;
    return corrected;
}

std::string CalibrationText(const PinholeCamera& camera, double offset_before_per_m,
                            const CalibrationReport& report) {
    const PinholeCamera found = Corrected(camera, report.calibration);
    std::string text = "calibration: ";
    if (!report.shown)
        text += "keeping the given values, the scan shows no clear error; estimated ";
    if (report.focal_sigma > 0)
        text += fmt::format("focal length {:.1f} -> {:.1f} +- {:.1f} px", camera.fx, found.fx,
                            found.fx * report.focal_sigma);
    if (report.offset_sigma_per_m > 0)
        text += fmt::format("{}frame.disparity_offset_per_m {:.4f} -> {:.4f} +- {:.4f}",
                            report.focal_sigma > 0 ? ", " : "", offset_before_per_m,
                            offset_before_per_m + report.calibration.disparity_offset_per_m,
                            report.offset_sigma_per_m);
    if (!report.shown) return text;
    return text + fmt::format(
                      "; distance of surfaces at {} points {:.1f} -> {:.1f} mm; rebuilding the map",
                      report.points, 1000 * report.rms_before_m, 1000 * report.rms_after_m);
}

}  // namespace tessera
