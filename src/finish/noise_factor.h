// How much more noise a place has than one that was measured from a metre away.
#pragma once

#include <algorithm>

namespace tessera {

// The depth's variance over that at a metre, where its standard deviation is 2 mm: as many more
// measurements make as good a mean. At most 20, which is reached at 3 m.
inline float NoiseFactor(float sigma_m) {
    const float relative = sigma_m / 0.002f;
    return std::min(relative * relative, 20.0f);
}

}  // namespace tessera
