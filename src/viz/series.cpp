#include "viz/series.h"

#include <cmath>

namespace tessera {

void AddValue(float value, Series& series) {
    series.push_back(value);
    if (series.size() > kSeriesLength) series.pop_front();
}

float AxisEnd(float value) {
    if (!(value > 0)) return 1;
    const float power = std::pow(10.0f, std::floor(std::log10(value)));
    for (const float factor : {1.0f, 2.0f, 5.0f})
        if (value <= factor * power * 1.0001f) return factor * power;
    return 10 * power;
}

}  // namespace tessera
