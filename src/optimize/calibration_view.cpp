#include "optimize/calibration_view.h"

#include <algorithm>

namespace tessera {
namespace {

// Mean of a block of pixels; 0 if a pixel has no depth or the surface is not smooth.
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
        for (int x = 0; x < depth_m_.width(); ++x)
            depth_m_(x, y) = MeanDepth(depth_m, kReduction * x, kReduction * y, kReduction);
}

PinholeCamera CalibrationView::ViewOf(const PinholeCamera& camera) {
    constexpr double kMiddle = 0.5 * (kReduction - 1);  // centre of a block, in pixels
    return {camera.width / kReduction,
            camera.height / kReduction,
            camera.fx / kReduction,
            camera.fy / kReduction,
            (camera.cx - kMiddle) / kReduction,
            (camera.cy - kMiddle) / kReduction};
}

}  // namespace tessera
