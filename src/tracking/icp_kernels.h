// One point's share of [D18] eq. 17 and of its photometric companion, beyond what normal_equations.h gives: templates on
// the number type, for vectors, tests and a GPU alike.
#pragma once

#include "core/scalar_ops.h"

namespace tessera {

// Huber's cost: r^2 up to the scale, then scale (2 |r| - scale). HuberWeight is its IRLS weight.
template <class F>
TESSERA_HD F HuberCost(const F& residual, const F& scale) {
    const F size = abs(residual);
    const F inner = min(size, scale);
    return inner * (size + size - inner);
}

// Between four pixels, (fu, fv) in [0, 1] from the first: value and slopes per pixel.
template <class F>
struct ImageSample {
    F value, du, dv;
};
template <class F>
TESSERA_HD ImageSample<F> Bilinear(const F& p00, const F& p10, const F& p01, const F& p11, const F& fu, const F& fv) {
    const F top = p00 + fu * (p10 - p00), bottom = p01 + fu * (p11 - p01);
    const F left = p10 - p00, right = p11 - p01;
    return {top + fv * (bottom - top), left + fv * (right - left), bottom - top};
}

// d(image)/d(point) of an image read where the point p (camera frame) projects: slopes times the projection's
// derivative.
template <class F>
TESSERA_HD void ImageGradientInSpace(const F* p, const F& fx, const F& fy, const F& du, const F& dv, F* g) {
    const F inverse_z = F(1.0f) / p[2];
    g[0] = du * fx * inverse_z;
    g[1] = dv * fy * inverse_z;
    g[2] = -(g[0] * p[0] + g[1] * p[1]) * inverse_z;
}

}  // namespace tessera
