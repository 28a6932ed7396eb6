#include "io/brightening.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace tessera {

Brightening::Brightening(int width, int height, double vignetting) {
    if (vignetting == 0) return;
    factors_.reserve(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const double middle_x = 0.5 * (width - 1), middle_y = 0.5 * (height - 1);
    const double corner2 = middle_x * middle_x + middle_y * middle_y;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double dx = x - middle_x, dy = y - middle_y;
            const double left = 1 - vignetting * (dx * dx + dy * dy) / corner2;
            factors_.insert(factors_.end(), 3, static_cast<std::uint16_t>(std::lround(256 / left)));
        }
}

void Brightening::Apply(ColourImage& colour) const {
    if (factors_.empty() || colour.empty()) return;
    TESSERA_CHECK(3 * colour.size() == factors_.size(), "{} x {}", colour.width(), colour.height());
    std::uint8_t* channel = &colour.data()->r;
    for (std::size_t i = 0; i < factors_.size(); ++i)
        channel[i] = static_cast<std::uint8_t>(
            std::min<std::uint32_t>((channel[i] * std::uint32_t{factors_[i]} + 128) >> 8, 255));
}

}  // namespace tessera
