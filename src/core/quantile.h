// Quantiles of values and depths.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/image.h"

namespace tessera {

// The value of rank floor(share * n) of n values, counted from 0. There is at least one; `share` is
// in [0, 1].
template <class T>
T Quantile(std::vector<T> values, double share) {
    TESSERA_CHECK(!values.empty() && share >= 0 && share <= 1, "{} values, {}", values.size(),
                  share);
    const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size()));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// The middle value; of an even number, the upper one of the two in the middle.
template <class T>
T Median(std::vector<T> values) {
    return Quantile(std::move(values), 0.5);
}

// Metres; 0 without depth.
inline float MedianDepth(const DepthImage& depth_m) {
    std::vector<float> known;
    std::copy_if(depth_m.data(), depth_m.data() + depth_m.size(), std::back_inserter(known),
                 [](float z) { return z > 0; });
    return known.empty() ? 0 : Median(std::move(known));
}

}  // namespace tessera
