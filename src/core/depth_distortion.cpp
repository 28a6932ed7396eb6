#include "core/depth_distortion.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace tessera {

bool DepthDistortion::IsValid() const {
    return columns >= 2 && rows >= 2 &&
           per_m.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) &&
           std::ranges::all_of(per_m, [](float error) { return std::isfinite(error); });
}

GridPlace PlaceInGrid(double u_px, double v_px, int width, int height, int columns, int rows) {
    const double x = std::clamp((u_px + 0.5) * columns / width - 0.5, 0.0, columns - 1.0),
                 y = std::clamp((v_px + 0.5) * rows / height - 0.5, 0.0, rows - 1.0);
    GridPlace place;
    place.column = std::min(static_cast<int>(x), columns - 2);
    place.row = std::min(static_cast<int>(y), rows - 2);
    place.right = static_cast<float>(x - place.column);
    place.below = static_cast<float>(y - place.row);
    return place;
}

DepthCorrection::DepthCorrection(const DepthDistortion& distortion, int width, int height) {
    if (distortion.empty()) return;
    TESSERA_CHECK(distortion.IsValid(), "{} x {} nodes, {} values", distortion.columns,
                  distortion.rows, distortion.per_m.size());
    const auto& [columns, rows, per_m] = distortion;
    error_per_m_.Resize(width, height);
    for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) {
            const GridPlace p = PlaceInGrid(u, v, width, height, columns, rows);
            const float* above = per_m.data() + p.row * columns + p.column;
            const float* below = above + columns;
            error_per_m_(u, v) = (1 - p.below) * (above[0] + p.right * (above[1] - above[0])) +
                                 p.below * (below[0] + p.right * (below[1] - below[0]));
        }
}

void DepthCorrection::Apply(double units_per_m, DepthImage& depth_m) const {
    if (depth_m.width() != error_per_m_.width() || depth_m.height() != error_per_m_.height())
        return;
    constexpr float kLeast = 0.1f;
    const float units = static_cast<float>(units_per_m), step = static_cast<float>(1 / units_per_m);
    float* z = depth_m.data();
    const float* error = error_per_m_.data();
    for (std::size_t i = 0; i < depth_m.size(); ++i) {
        const float share = 1 - error[i] * z[i];
        z[i] = share > kLeast ? std::nearbyint(z[i] / share * units) * step : 0.0f;
    }
}

}  // namespace tessera
