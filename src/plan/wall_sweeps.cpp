#include "plan/wall_sweeps.h"

#include <array>
#include <cmath>
#include <numbers>

namespace tessera {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kAround = 20 * kDegree;  // normals of a noisy wall from its own
constexpr int kAngles = 720;              // a quarter of a degree each, over half a turn
constexpr std::size_t kMostDirections = 12;

// Angles of the directions, modulo half a turn, in which the most surface faces.
std::vector<double> DirectionsOf(const PlanEvidence& evidence) {
    constexpr int kApart = 4 * 6;  // 6 degrees
    constexpr double kLeastShare = 0.02;
    std::array<double, kAngles> histogram{}, smooth{};
    for (const UprightPoint& point : evidence.upright) {
        const double angle = std::atan2(point.normal.y(), point.normal.x());
        ++histogram[static_cast<std::size_t>(
            static_cast<int>(std::floor((angle / std::numbers::pi + 2) * kAngles)) % kAngles)];
    }
    for (int i = 0; i < kAngles; ++i)
        for (int k = -4; k <= 4; ++k)
            smooth[static_cast<std::size_t>(i)] +=
                (5 - std::abs(k)) *
                histogram[static_cast<std::size_t>((i + k + kAngles) % kAngles)] / 25;
    double total = 0;
    for (const double count : histogram) total += count;
    std::vector<double> directions;
    while (directions.size() < kMostDirections) {
        const auto most = std::ranges::max_element(smooth);
        if (*most * 9 < kLeastShare * total || *most <= 0) break;
        const int at = static_cast<int>(most - smooth.begin());
        directions.push_back((at + 0.5) * std::numbers::pi / kAngles);
        for (int k = -kApart; k <= kApart; ++k)
            smooth[static_cast<std::size_t>((at + k + kAngles) % kAngles)] = 0;
    }
    return directions;
}

}  // namespace

bool WallSweeps::Faces(const Sweep& sweep, std::uint32_t point) const {
    return evidence_.upright[point].normal.cast<double>().dot(sweep.normal) > std::cos(kAround);
}

// In float, by which points are sorted, so that bins have the same order.
float WallSweeps::OffsetOf(const Sweep& sweep, std::uint32_t point) const {
    return static_cast<float>(evidence_.upright[point].position.cast<double>().dot(sweep.normal));
}

std::int64_t WallSweeps::BinOf(const Sweep& sweep, std::uint32_t point) const {
    return static_cast<std::int64_t>(
        std::floor(static_cast<double>(OffsetOf(sweep, point)) / kBin_m));
}

WallSweeps::WallSweeps(const PlanEvidence& evidence)
    : evidence_(evidence), taken_(evidence.upright.size()) {
    for (const double angle : DirectionsOf(evidence))
        for (const double side : {1.0, -1.0}) {
            Sweep sweep;
            sweep.normal = side * Eigen::Vector2d(std::cos(angle), std::sin(angle));
            for (std::uint32_t i = 0; i < evidence.upright.size(); ++i)
                if (Faces(sweep, i)) sweep.sorted.emplace_back(OffsetOf(sweep, i), i);
            if (sweep.sorted.empty()) continue;
            std::ranges::sort(sweep.sorted);
            sweep.first = BinOf(sweep, sweep.sorted.front().second);
            const std::int64_t last = BinOf(sweep, sweep.sorted.back().second);
            sweep.counts.assign(
                static_cast<std::size_t>(std::max<std::int64_t>(1, last - sweep.first + 1)), 0);
            for (const auto& [offset, point] : sweep.sorted)
                ++sweep.counts[static_cast<std::size_t>(BinOf(sweep, point) - sweep.first)];
            sweeps_.push_back(std::move(sweep));
        }
}

WallSweeps::Peak WallSweeps::Largest() const {
    Peak peak;
    std::uint32_t most = 0;
    for (std::size_t s = 0; s < sweeps_.size(); ++s) {
        const std::vector<std::uint32_t>& counts = sweeps_[s].counts;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const std::uint32_t count = counts[i] + (i > 0 ? counts[i - 1] : 0) +
                                        (i + 1 < counts.size() ? counts[i + 1] : 0);
            if (count <= most) continue;
            most = count;
            peak.sweep = s;
            peak.line = {sweeps_[s].normal, kBin_m * (static_cast<double>(sweeps_[s].first) +
                                                      static_cast<double>(i) + 0.5)};
        }
    }
    peak.area_m2 = most * evidence_.spacing_m * evidence_.spacing_m;
    return peak;
}

std::vector<std::uint32_t> WallSweeps::Near(const Peak& peak, double reach_m) const {
    std::vector<std::uint32_t> near;
    const auto& sorted = sweeps_[peak.sweep].sorted;
    const auto low = static_cast<float>(peak.line.offset_m - reach_m),
               high = static_cast<float>(peak.line.offset_m + reach_m);
    for (auto at = std::ranges::lower_bound(sorted, std::pair{low, std::uint32_t{0}});
         at != sorted.end() && at->first <= high; ++at)
        if (!taken_[at->second]) near.push_back(at->second);
    return near;
}

void WallSweeps::Take(const std::vector<std::uint32_t>& points) {
    for (const std::uint32_t point : points) {
        if (taken_[point]) continue;
        taken_[point] = true;
        for (Sweep& sweep : sweeps_)
            if (Faces(sweep, point))
                --sweep.counts[static_cast<std::size_t>(BinOf(sweep, point) - sweep.first)];
    }
}

void WallSweeps::TakePeak(const Peak& peak) { Take(Near(peak, 1.6 * kBin_m)); }

}  // namespace tessera
