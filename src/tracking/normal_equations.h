// One point's contribution to [B14] eq. 8-11: residuals, Jacobians, robust weights and normal
// equations. Templates on the number type: the same code runs in the SIMD kernels, in the tests
// with plain floats, and on a GPU.
//
// The unknowns are a left increment (rotation, translation) of T_world_camera about a world point O
// near the camera ("local" coordinates are world coordinates minus O), and the frame's brightness:
// gain a and offset b with field intensity ~ a * image intensity + b.
#pragma once

#include "core/scalar_ops.h"
#include "mapping/trilinear.h"

namespace tessera {

// Point arrays are padded to a multiple of this with points of weight 0.
inline constexpr int kPointPadding = 8;

// Sums over points. Symmetric matrices store the upper triangle, row by row. Distances and
// intensities are summed separately and without alpha, so that the information of each about the
// pose does not depend on their relative weight.
struct SumLayout {
    // A pose term, at kDistance and at kIntensity: pose x pose (21), then pose x residual (6).
    static constexpr int kHessian = 0, kGradient = 21, kPoseTerm = 27;
    static constexpr int kDistance = 0;
    static constexpr int kIntensity = kPoseTerm;
    static constexpr int kCoupling = 54;            // 12: pose x (gain, offset)
    static constexpr int kBrightness = 66;          // 3: gain^2, gain offset, offset^2
    static constexpr int kBrightnessGradient = 69;  // 2
    static constexpr int kDistanceError = 71;       // sum of w r^2, distance, m^2
    static constexpr int kIntensityError = 72;      // the same for intensity
    static constexpr int kDistanceWeight = 73;      // sum of w
    static constexpr int kIntensityWeight = 74;
    static constexpr int kKnown = 75;     // points with a known distance
    static constexpr int kInliers = 76;   // of these, those with |r| below half the band
    static constexpr int kColoured = 77;  // points with a known intensity
    // For methods that accept or reject steps: the robust energy ([B14] eq. 8, with alpha) of the
    // residuals that exist both here and at the previous pose, and the energy of the same residuals
    // there.
    static constexpr int kEnergy = 78;
    static constexpr int kEnergyBefore = 79;
    static constexpr int kBand =
        80;  // sum of w b^2, b: half width of the band at the point's depth
    static constexpr int kCount = 81;
};

// Huber's weight: 1 up to the scale, then scale / |r|.
template <class F>
TESSERA_HD F HuberWeight(const F& residual, const F& scale) {
    return scale / max(abs(residual), scale);
}

// d(residual)/d(increment) for a residual f(p) of a point p in local coordinates with gradient g:
// (p x g, g).
template <class F>
TESSERA_HD void PointJacobian(const F* p, const F* g, F* j) {
    j[0] = p[1] * g[2] - p[2] * g[1];
    j[1] = p[2] * g[0] - p[0] * g[2];
    j[2] = p[0] * g[1] - p[1] * g[0];
    j[3] = g[0];
    j[4] = g[1];
    j[5] = g[2];
}

// Adds w J J^T and w J r to a pose term.
template <class F>
TESSERA_HD void AddPoseTerm(const F* j, const F& residual, const F& w, F* term) {
    int at = SumLayout::kHessian;
    for (int row = 0; row < 6; ++row) {
        const F wj = w * j[row];
        for (int column = row; column < 6; ++column, ++at) term[at] = term[at] + wj * j[column];
        term[SumLayout::kGradient + row] = term[SumLayout::kGradient + row] + wj * residual;
    }
}

// The photometric residual of [B14] eq. 6 and 7 is the square root of sum_c s_c e_c^2 over the
// errors e_c of R, G and B, with the weights s_c of luma. With e_Y = sum_c s_c e_c and the chroma
// errors e_Cb = (e_B - e_Y) / 1.772 and e_Cr = (e_R - e_Y) / 1.402 the sum is
//     e_Y^2 + a e_Cb^2 + 2 b e_Cb e_Cr + c e_Cr^2
//       = e_Y^2 + (u e_Cb + v e_Cr)^2 + (w e_Cr)^2,
// a = 0.114 * 1.772^2 + (0.114 * 1.772)^2 / 0.587, b = 0.114 * 1.772 * 0.299 * 1.402 / 0.587,
// c = 0.299 * 1.402^2 + (0.299 * 1.402)^2 / 0.587, u = sqrt(a), v = b / u, w = sqrt(c - v^2).
struct ChromaWeights {
    static constexpr float kU = 0.65381684f, kV = 0.22064473f, kW = 0.91563967f;
};

// The gain's terms of a residual r = field - a * image: dr/da = -image.
template <class F>
TESSERA_HD void AddGainTerm(const F* j, const F& residual, const F& image, const F& w, F* sums) {
    using L = SumLayout;
    const F wi = w * image;
    for (int row = 0; row < 6; ++row)
        sums[L::kCoupling + 2 * row] = sums[L::kCoupling + 2 * row] - wi * j[row];
    sums[L::kBrightness] = sums[L::kBrightness] + wi * image;
    sums[L::kBrightnessGradient] = sums[L::kBrightnessGradient] - wi * residual;
}

// The brightness terms of the intensity residual r = field - (a * image + b): dr/da = -image,
// dr/db = -1.
template <class F>
TESSERA_HD void AddBrightnessTerm(const F* j, const F& residual, const F& image, const F& w,
                                  F* sums) {
    using L = SumLayout;
    AddGainTerm(j, residual, image, w, sums);
    for (int row = 0; row < 6; ++row)
        sums[L::kCoupling + 2 * row + 1] = sums[L::kCoupling + 2 * row + 1] - w * j[row];
    sums[L::kBrightness + 1] = sums[L::kBrightness + 1] + w * image;
    sums[L::kBrightness + 2] = sums[L::kBrightness + 2] + w;
    sums[L::kBrightnessGradient + 1] = sums[L::kBrightnessGradient + 1] - w * residual;
}

}  // namespace tessera
