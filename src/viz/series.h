// The most recent values of one quantity, for a rolling plot.
#pragma once

#include <cstddef>
#include <deque>

namespace tessera {

using Series = std::deque<float>;  // oldest first
inline constexpr std::size_t kSeriesLength = 240;

// Adds the newest value. Drops the oldest if there are more than kSeriesLength.
void AddValue(float value, Series& series);

// The smallest value of 1, 2, 5, 10, 20, ... times a power of ten that is not below `value`; the
// end of a plot's axis.
float AxisEnd(float value);

}  // namespace tessera
