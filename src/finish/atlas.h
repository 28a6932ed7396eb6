// A texture's layout: charts as boxes in one image.
#pragma once

#include <vector>

#include "core/status.h"
#include "finish/charts.h"

namespace tessera {

struct Atlas {
    int width = 0, height = 0;  // texels
    double texel_m = 0;         // side of a texel on the surface (of what faces its chart)
    // Per chart, the texel of its origin. Around each chart's box are kMargin texels of its own.
    std::vector<Eigen::Vector2i> corner;
    static constexpr int kMargin = 2;

    // Texels from the image's top-left texel's centre.
    Eigen::Vector2f TexelOf(const Chart& chart, std::size_t number,
                            const Eigen::Vector3f& p) const {
        return chart.Place(p) / static_cast<float>(texel_m) + corner[number].cast<float>();
    }
};

// Lays the charts into the smallest image of a power of two wide, at most max_side wide and high.
// If they do not fit, the texels are made larger until they do; an error if that takes texels of a
// metre. Deterministic; thread-safe.
Result<Atlas> PackCharts(const std::vector<Chart>& charts, double texel_m, int max_side);

}  // namespace tessera
