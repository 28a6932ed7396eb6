// Trilinear interpolation: value and analytic gradient from eight corners. A template on the number
// type, shared by the scalar samplers, the SIMD kernels and CUDA.
#pragma once

#include "core/host_device.h"

namespace tessera {

template <class F>
struct ValueAndGradient {
    F value;
    F gx, gy, gz;  // per unit of the fractions, i.e. per voxel
};

// corner[i] is at offsets (x, y, z) = bits 0, 1, 2 of i; fractions in [0, 1].
template <class F>
TESSERA_HD ValueAndGradient<F> Trilinear(const F* corner, const F& fx, const F& fy, const F& fz) {
    const F x00 = corner[1] - corner[0], x10 = corner[3] - corner[2];
    const F x01 = corner[5] - corner[4], x11 = corner[7] - corner[6];
    const F c00 = corner[0] + fx * x00, c10 = corner[2] + fx * x10;
    const F c01 = corner[4] + fx * x01, c11 = corner[6] + fx * x11;
    const F y0 = c10 - c00, y1 = c11 - c01;
    const F c0 = c00 + fy * y0, c1 = c01 + fy * y1;
    const F gx0 = x00 + fy * (x10 - x00), gx1 = x01 + fy * (x11 - x01);
    return {c0 + fz * (c1 - c0), gx0 + fz * (gx1 - gx0), y0 + fz * (y1 - y0), c1 - c0};
}

}  // namespace tessera
