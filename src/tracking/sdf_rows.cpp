#include "tracking/sdf_rows.h"

#include <limits>

#include "core/vector_types.h"
#include "mapping/block_rows.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {
namespace {

using L = SumLayout;
static_assert(kPointPadding % kLanes == 0);

// The words at the eight corners of the cells with lower voxel (x, y, z), local coordinates.
[[gnu::always_inline]] inline void GatherCorners(const SdfArguments& a, const Int& x, const Int& y, const Int& z,
                                                 const RealMask& wanted, Int* words) {
    const Int block = FindBlocks(a, (x >> 3) + Int(a.origin_block[0]), (y >> 3) + Int(a.origin_block[1]),
                                 (z >> 3) + Int(a.origin_block[2]), wanted);
    const Int voxel[3] = {x, y, z};
    Int index[8];
    CornerVoxels(a, block, voxel, index);
    for (int c = 0; c < 8; ++c) words[c] = Gather(reinterpret_cast<const std::int32_t*>(a.field), index[c]);
}

struct Sums {
    Real value[L::kCount];
};

[[gnu::always_inline]] inline void Add(Sums& s, int at, const Real& v) { s.value[at] = s.value[at] + v; }

[[gnu::always_inline]] inline Real Masked(const RealMask& m, const Real& v) { return Select(m, v, Real(0.0f)); }

[[gnu::always_inline]] inline void StoreResidual(float* target, int i, const RealMask& valid, const Real& r) {
    if (target == nullptr) return;
    Select(valid, r, Real(std::numeric_limits<float>::quiet_NaN())).store_unaligned(target + i);
}

// The geometric half of [B14] eq. 10: r = psi(p).
[[gnu::always_inline]] inline void AddDistance(const SdfArguments& a, int i, const Real* p, const Real* fraction,
                                               const Int* words, const RealMask& known, const Real& point_weight,
                                               Sums& sums) {
    Real corner[8];
    for (int c = 0; c < 8; ++c) corner[c] = xsimd::to_float(words[c] >> 16);
    const auto s = Trilinear(corner, fraction[0], fraction[1], fraction[2]);
    const Real to_m(a.truncation_m / kDistanceSteps), slope(a.truncation_m / (kDistanceSteps * a.voxel_size_m));
    // A distance measured along a slanted ray is too long, and so is its gradient: divide by the gradient's length.
    Real steepness(1.0f);
    if (a.normalise)
        steepness = Real(1.0f) / xsimd::max(Real(1.0f), xsimd::sqrt(s.gx * s.gx + s.gy * s.gy + s.gz * s.gz) * slope);
    const Real residual = s.value * to_m * steepness;
    const Real g[3] = {s.gx * slope * steepness, s.gy * slope * steepness, s.gz * slope * steepness};
    const Real scale(a.distance_scale_m);
    const Real w = Masked(known, point_weight * HuberWeight(residual, scale));
    Real j[6];
    PointJacobian(p, g, j);
    AddPoseTerm(j, residual, w, sums.value);
    Add(sums, L::kDistanceError, w * residual * residual);
    Add(sums, L::kDistanceWeight, w);
    const RealMask counted = known & (point_weight > Real(0.0f));
    Add(sums, L::kKnown, Masked(counted, Real(1.0f)));
    Add(sums, L::kInliers, Masked(counted & (xsimd::abs(residual) < Real(a.inlier_distance_m)), Real(1.0f)));
    StoreResidual(a.distance_residual, i, counted, residual);
}

// The photometric half: r = psi_I(p) - (gain * image + offset).
[[gnu::always_inline]] inline void AddIntensity(const SdfArguments& a, int i, const Real* p, const Real* fraction,
                                                const Int* words, RealMask known, const Real& point_weight,
                                                Sums& sums) {
    Real corner[8];
    for (int c = 0; c < 8; ++c) {
        const Int intensity = words[c] & Int(0xffff);
        known = known & AsRealMask(intensity != Int(0));
        corner[c] = xsimd::to_float(intensity);
    }
    const Real image = Load(a.intensity + i);
    known = known & (image >= Real(0.0f)) & (point_weight > Real(0.0f));
    if (xsimd::any(known)) {
        const auto s = Trilinear(corner, fraction[0], fraction[1], fraction[2]);
        const Real to_one(1.0f / kIntensitySteps), slope(1.0f / (kIntensitySteps * a.voxel_size_m));
        const Real residual = (s.value - Real(1.0f)) * to_one - (Real(a.gain) * image + Real(a.offset));
        const Real g[3] = {s.gx * slope, s.gy * slope, s.gz * slope};
        const Real w = Masked(known, point_weight * HuberWeight(residual, Real(a.intensity_scale)));
        const Real weighted = w * Real(a.alpha);
        Real j[6];
        PointJacobian(p, g, j);
        AddPoseTerm(j, residual, weighted, sums.value);
        AddBrightnessTerm(j, residual, image, weighted, sums.value);
        Add(sums, L::kIntensityError, w * residual * residual);
        Add(sums, L::kIntensityWeight, w);
        Add(sums, L::kColoured, Masked(known, Real(1.0f)));
        StoreResidual(a.intensity_residual, i, known, residual);
    } else {
        StoreResidual(a.intensity_residual, i, known, Real(0.0f));
    }
}

}  // namespace

void SumSdfPoints(const SdfArguments& a, int first, int last, double* sums) {
    Sums lanes;
    for (Real& value : lanes.value) value = Real(0.0f);
    for (int i = first; i < last; i += kLanes) {
        const Real x = Load(a.x + i), y = Load(a.y + i), z = Load(a.z + i);
        const Real weight = Load(a.weight + i);
        Real p[3], fraction[3];
        Int cell[3];
        for (int k = 0; k < 3; ++k) {
            const float* r = a.rotation + 3 * k;
            const Real q = Real(r[0]) * x + Real(r[1]) * y + Real(r[2]) * z + Real(a.translation[k]);
            const Real lower = xsimd::floor(q);
            cell[k] = xsimd::to_int(lower);
            fraction[k] = q - lower;
            p[k] = q * Real(a.voxel_size_m);
        }
        Int words[8];
        GatherCorners(a, cell[0], cell[1], cell[2], weight > Real(0.0f), words);
        // Unknown corners have the sentinel -32768 as distance.
        Int lowest = words[0] >> 16;
        for (int c = 1; c < 8; ++c) lowest = xsimd::min(lowest, words[c] >> 16);
        const RealMask known = AsRealMask(lowest != Int(-32768));
        if (!xsimd::any(known)) {
            StoreResidual(a.distance_residual, i, known, Real(0.0f));
            StoreResidual(a.intensity_residual, i, known, Real(0.0f));
            continue;
        }
        AddDistance(a, i, p, fraction, words, known, weight, lanes);
        if (a.alpha > 0.0f) AddIntensity(a, i, p, fraction, words, known, weight, lanes);
    }
    for (int k = 0; k < L::kCount; ++k) sums[k] += static_cast<double>(xsimd::hadd(lanes.value[k]));
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
