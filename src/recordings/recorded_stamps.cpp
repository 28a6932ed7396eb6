#include "recordings/recorded_stamps.h"

#include <cmath>

#include "core/quantile.h"

namespace tessera {

std::vector<RecordedPair> EvenlyStamped(std::size_t count, double fps) {
    std::vector<RecordedPair> pairs(count);
    for (std::size_t i = 0; i < count; ++i)
        pairs[i].depth_stamp_s = pairs[i].colour_stamp_s = static_cast<double>(i) / fps;
    return pairs;
}

bool DepthStampsIncrease(std::span<const RecordedPair> pairs) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!std::isfinite(pairs[i].depth_stamp_s)) return false;
        if (i > 0 && pairs[i].depth_stamp_s <= pairs[i - 1].depth_stamp_s) return false;
    }
    return true;
}

double MedianFps(std::span<const RecordedPair> pairs, double otherwise) {
    if (pairs.size() < 2) return otherwise;
    std::vector<double> gaps_s;
    gaps_s.reserve(pairs.size());
    for (std::size_t i = 1; i < pairs.size(); ++i)
        gaps_s.push_back(pairs[i].depth_stamp_s - pairs[i - 1].depth_stamp_s);
    return 1 / Median(gaps_s);
}

}  // namespace tessera
