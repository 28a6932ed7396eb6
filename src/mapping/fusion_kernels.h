// The formulas of fusion, one voxel at a time: weights of both papers, the running averages, the rounding. Templates on
// the number type, so that the scalar code, the vector code and CUDA share them. Distances in metres, positive in
// front of the surface: [B14] eq. 12 has the opposite sign.
#pragma once

#include <cstdint>

#include "core/scalar_ops.h"
#include "mapping/voxel.h"

namespace tessera {

enum class DistanceWeight {
    kConstant,    // 1                                  [D18] eq. 7
    kLinearExp,   // 1, falling behind the surface      [B14] eq. 13
    kDepthNoise,  // (1 m / z)^2: structured light's depth noise grows with z^2
};

enum class ColourWeighting {
    kCosine,  // cos(theta) * w(d)    [B14] eq. 17
    kSame,    // w(d)                 [D18] eq. 6
};

// [B14] eq. 13 with d = z_voxel - z_measured = -signed_distance: 1 up to epsilon behind the surface, then
// exp(-sigma (d - epsilon)^2). `exponential` is the caller's exp for F. The cut at delta is the caller's.
template <class F, class Exp>
TESSERA_HD F LinearExpWeight(F signed_distance_m, float epsilon_m, float sigma, Exp exponential) {
    const F behind = F(0.0f) - signed_distance_m - F(epsilon_m);
    const F beyond = max(behind, F(0.0f));
    return exponential(F(-sigma) * beyond * beyond);
}

// [B14] eq. 14, [D18] eq. 5 and 6: the weighted running average.
template <class F>
TESSERA_HD F WeightedAverage(F old_value, F old_weight, F value, F weight) {
    return (old_weight * old_value + weight * value) / (old_weight + weight);
}

// 32 well-mixed bits from a voxel's address and the frame: the dither of the running averages. Rounding to nearest
// would freeze an average once the weight is large; rounding up with the probability of the fraction moves it right
// in the mean, and a hash makes every run the same.
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
