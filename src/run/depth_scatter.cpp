#include "run/depth_scatter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace tessera {
namespace {

constexpr int kColumns = 640, kApart = 12;  // pixels between two of the three, of so many columns
constexpr int kEvery = 3;                   // rows and columns that are looked at
constexpr int kQuarters = 4;
// The mean of the smaller three quarters of |x|, for a normal x of variance 6: that of a - 2 b + c,
// each of variance 1. A median would jump where depth has few levels, as a Kinect's.
const double kMeanOfThree = 0.51491 * std::sqrt(6.0);

struct Deviation {
    float depth_m;
    float per_m;  // of inverse depth from a line
};

double SigmaPerM(std::span<Deviation> quarter) {
    const auto end = quarter.begin() + static_cast<std::ptrdiff_t>(3 * quarter.size() / 4);
    std::ranges::nth_element(quarter, end, {}, &Deviation::per_m);
    double sum = 0;
    for (auto at = quarter.begin(); at != end; ++at) sum += at->per_m;
    return sum / static_cast<double>(end - quarter.begin()) / kMeanOfThree;
}

}  // namespace

DepthScatter MeasureDepthScatter(const Image<float>& depth_m, double max_depth_m) {
    const int width = depth_m.width(), height = depth_m.height();
    const int apart = std::max(1, (kApart * width + kColumns / 2) / kColumns);
    std::vector<Deviation> seen;
    const auto add = [&](int x, int y, int dx, int dy) {
        const float a = depth_m(x - dx, y - dy), b = depth_m(x, y), c = depth_m(x + dx, y + dy);
        if (a > 0 && b > 0 && c > 0 && b <= max_depth_m)
            seen.push_back({b, std::abs(1 / a - 2 / b + 1 / c)});
    };
    for (int y = apart; y < height - apart; y += kEvery)
        for (int x = apart; x < width - apart; x += kEvery) {
            add(x, y, apart, 0);
            add(x, y, 0, apart);
        }
    if (seen.size() < 4 * kQuarters) return {};
    std::ranges::sort(seen, {}, &Deviation::depth_m);
    DepthScatter scatter{std::numeric_limits<double>::infinity(), seen[seen.size() / 2].depth_m,
                         static_cast<std::int64_t>(seen.size())};
    for (std::size_t i = 0; i < kQuarters; ++i) {
        const std::size_t first = i * seen.size() / kQuarters,
                          last = (i + 1) * seen.size() / kQuarters;
        scatter.sigma_per_m =
            std::min(scatter.sigma_per_m, SigmaPerM(std::span(seen).subspan(first, last - first)));
    }
    return scatter;
}

}  // namespace tessera
