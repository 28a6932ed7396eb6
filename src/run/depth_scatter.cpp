#include "run/depth_scatter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/quantile.h"

namespace tessera {
namespace {

constexpr int kColumns = 640, kApart = 12;  // pixels between two of the three, of so many columns
constexpr int kEvery = 3;                   // rows and columns that are looked at
// Median of |x| for a normal x of variance 6: that of a - 2 b + c, each of variance 1.
const double kMedianOfThree = 0.6745 * std::sqrt(6.0);

}  // namespace

DepthScatter MeasureDepthScatter(const Image<float>& depth_m, double max_depth_m) {
    const int width = depth_m.width(), height = depth_m.height();
    const int apart = std::max(1, (kApart * width + kColumns / 2) / kColumns);
    std::vector<float> deviations_m, depths_m;
    const auto add = [&](int x, int y, int dx, int dy) {
        const float a = depth_m(x - dx, y - dy), b = depth_m(x, y), c = depth_m(x + dx, y + dy);
        if (!(a > 0) || !(b > 0) || !(c > 0) || !(b <= max_depth_m)) return;
        deviations_m.push_back(std::abs(1 / a - 2 / b + 1 / c) * b * b);
        depths_m.push_back(b);
    };
    for (int y = apart; y < height - apart; y += kEvery)
        for (int x = apart; x < width - apart; x += kEvery) {
            add(x, y, apart, 0);
            add(x, y, 0, apart);
        }
    if (depths_m.empty()) return {};
    return {Median(deviations_m) / kMedianOfThree, Median(depths_m),
            static_cast<std::int64_t>(depths_m.size())};
}

}  // namespace tessera
