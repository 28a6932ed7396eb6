#include <fmt/format.h>

#include <algorithm>

#include "optimize/self_calibration.h"

namespace tessera {
namespace {

// Mean of a block of pixels; 0 where one is missing, or where it is no smooth surface.
float MeanDepth(const DepthImage& depth_m, int x, int y, int size) {
    constexpr float kSpread = 0.03f;  // share of the depth
    float sum = 0, low = 1e9f, high = 0;
    for (int v = y; v < y + size; ++v)
        for (int u = x; u < x + size; ++u) {
            const float z = depth_m(u, v);
            sum += z;
            low = std::min(low, z);
            high = std::max(high, z);
        }
    return low > 0 && high - low <= kSpread * high ? sum / static_cast<float>(size * size) : 0;
}

}  // namespace

CalibrationView::CalibrationView(const DepthImage& depth_m)
    : depth_m_(depth_m.width() / kReduction, depth_m.height() / kReduction) {
    for (int y = 0; y < depth_m_.height(); ++y)
        for (int x = 0; x < depth_m_.width(); ++x) depth_m_(x, y) = MeanDepth(depth_m, kReduction * x, kReduction * y, kReduction);
}

PinholeCamera CalibrationView::ViewOf(const PinholeCamera& camera) {
    constexpr double kMiddle = 0.5 * (kReduction - 1);  // of a block's pixels
    return {camera.width / kReduction, camera.height / kReduction, camera.fx / kReduction, camera.fy / kReduction,
            (camera.cx - kMiddle) / kReduction, (camera.cy - kMiddle) / kReduction};
}

PinholeCamera Corrected(const PinholeCamera& camera, const Calibration& calibration) {
    PinholeCamera corrected = camera;
    corrected.fx *= calibration.focal_scale;
    corrected.fy *= calibration.focal_scale;
    return corrected;
}

std::string CalibrationText(const PinholeCamera& camera, const CalibrationReport& report) {
    const PinholeCamera found = Corrected(camera, report.calibration);
    return fmt::format("calibration: fx {:.2f}, fy {:.2f} px (were {:.2f}, {:.2f}; +- {:.2f} %), frame.disparity_offset_per_m {:+.5f} "
                       "(+- {:.5f}); distances between views {:.2f} mm, were {:.2f}; the map is made again with it",
                       found.fx, found.fy, camera.fx, camera.fy, 100 * report.focal_sigma, report.calibration.disparity_offset_per_m,
                       report.offset_sigma_per_m, 1000 * report.rms_after_m, 1000 * report.rms_before_m);
}

}  // namespace tessera
