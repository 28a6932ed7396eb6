// Bilinear interpolation of an image in which missing pixels are 0 (depth) or negative (intensity).
#pragma once

#include <algorithm>

#include "core/image.h"

namespace tessera {

struct BilinearSample {
    double value, du, dv;  // and its derivatives per pixel
    float least;           // smallest of the four pixels: shows whether one is missing
};

// 0 <= u < width - 1, 0 <= v < height - 1.
inline BilinearSample SampleBilinear(const Image<float>& image, double u, double v) {
    const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
    const double fu = u - u0, fv = v - v0;
    const float *top = image.row(v0) + u0, *bottom = image.row(v0 + 1) + u0;
    const double above = top[0] + fu * (top[1] - top[0]),
                 below = bottom[0] + fu * (bottom[1] - bottom[0]);
    return {above + fv * (below - above),
            (1 - fv) * (top[1] - top[0]) + fv * (bottom[1] - bottom[0]), below - above,
            std::min(std::min(top[0], top[1]), std::min(bottom[0], bottom[1]))};
}

}  // namespace tessera
