// The formulas of fusion: the weights of both papers, the running average, and the dither that
// rounds it. Templates on the number type, for the CPU's SIMD kernels and CUDA.
#pragma once

#include <cstdint>

#include "core/scalar_ops.h"

namespace tessera {

// e^v for v <= 0, with the same few roundings for every F. Accurate to 1e-6, and to 3e-9 below
// e^-10. Computed as (e^(v / 16))^16 from the series.
template <class F>
TESSERA_HD F ExpOfNegative(F v) {
    constexpr float kFactorials[] = {5040, 720, 120, 24, 6, 2, 1, 1};
    const F t = max(v, F(-20.0f)) * F(1.0f / 16.0f);
    F e(1.0f / kFactorials[0]);
    for (int i = 1; i < 8; ++i) e = e * t + F(1.0f / kFactorials[i]);
    for (int i = 0; i < 4; ++i) e = e * e;
    return e;
}

// [B14] eq. 13 with d = z_voxel - z_measured = -signed_distance: 1 up to epsilon behind the
// surface, then exp(-sigma (d - epsilon)^2). The caller applies the cut at delta.
template <class F>
TESSERA_HD F LinearExpWeight(F signed_distance_m, float epsilon_m, float sigma) {
    const F behind = F(0.0f) - signed_distance_m - F(epsilon_m);
    const F beyond = max(behind, F(0.0f));
    return ExpOfNegative(F(-sigma) * beyond * beyond);
}

// [B14] eq. 14, [D18] eq. 5 and 6: the weighted running average.
template <class F>
TESSERA_HD F WeightedAverage(F old_value, F old_weight, F value, F weight) {
    return (old_weight * old_value + weight * value) / (old_weight + weight);
}

// 32 well-mixed bits from a voxel's address and the frame, to dither the running averages. Rounding
// to nearest would freeze an average once the weight is large. Rounding up with a probability equal
// to the fraction keeps the mean correct. A hash makes runs reproducible.
template <class U>
TESSERA_HD U DitherBits(U address, std::uint32_t frame) {
    U h = address * U(0x9e3779b1u) + U(frame * 0x85ebca77u);
    h = h ^ (h >> 16);
    h = h * U(0x7feb352du);
    h = h ^ (h >> 15);
    h = h * U(0x846ca68bu);
    return h ^ (h >> 16);
}

}  // namespace tessera
