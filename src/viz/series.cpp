#include "viz/series.h"

#include <algorithm>
#include <cmath>

namespace tessera {

void Series::Add(float value) {
    values_[next_] = value;
    next_ = (next_ + 1) % values_.size();
    size_ = std::min(size_ + 1, values_.size());
}

float Series::operator[](std::size_t i) const {
    return values_[(next_ + values_.size() - size_ + i) % values_.size()];
}

float Series::max() const {
    float most = 0;
    for (std::size_t i = 0; i < size_; ++i) most = std::max(most, (*this)[i]);
    return most;
}

float AxisEnd(float value) {
    if (!(value > 0)) return 1;
    const float power = std::pow(10.0f, std::floor(std::log10(value)));
    for (const float factor : {1.0f, 2.0f, 5.0f})
        if (value <= factor * power * 1.0001f) return factor * power;
    return 10 * power;
}

}  // namespace tessera
