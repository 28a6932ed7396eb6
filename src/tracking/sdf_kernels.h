// The SDF tracker's sums: one point's contribution to the normal equations of [B14] eq. 8. Works on
// lanes of points (scalar_lanes.h), for the CPU's SIMD kernels and CUDA.
#pragma once

#include <limits>

#include "mapping/block_kernels.h"
#include "tracking/normal_equations.h"
#include "tracking/sdf_arguments.h"

namespace tessera {

// The sums for lanes V of points.
template <class V>
class SdfKernels {
  public:
    using Real = typename V::Real;
    using Int = typename V::Int;
    using Mask = typename V::Mask;

    // Adds the contributions of points [i, i + V::kCount) to sums[], laid out as SumLayout, and
    // writes their residuals.
    TESSERA_HD_MEMBER static void AddPoints(const SdfArguments& a, int i, Real* sums) {
        const Real x = V::Load(a.x + i), y = V::Load(a.y + i), z = V::Load(a.z + i);
        const Real weight = V::Load(a.weight + i);
        Real p[3], fraction[3];
        Int cell[3];
        for (int k = 0; k < 3; ++k) {
            const float* r = a.rotation + 3 * k;
            const Real q =
                Real(r[0]) * x + Real(r[1]) * y + Real(r[2]) * z + Real(a.translation[k]);
            const Real lower = V::Floor(q);
            cell[k] = V::ToInt(lower);
            fraction[k] = q - lower;
            p[k] = q * Real(a.voxel_size_m);
        }
        Int words[8];
        GatherCorners(a, cell, weight > Real(0.0f), words);
        // Unknown corners have the sentinel -32768 as distance.
        Int lowest = words[0] >> 16;
        for (int c = 1; c < 8; ++c) lowest = V::Min(lowest, words[c] >> 16);
        const Mask known = V::ToMask(lowest != Int(-32768));
        if (!V::Any(known)) {
            StoreResidual(a.distance_residual, i, known, Real(0.0f));
            StoreResidual(a.intensity_residual, i, known, Real(0.0f));
            return;
        }
        AddDistance(a, i, p, fraction, words, known, weight, sums);
        if (a.use_intensity) AddIntensity(a, i, p, fraction, words, known, weight, sums);
    }

  private:
    using L = SumLayout;

    // The words at the eight corners of cells. `voxel` is a cell's lowest voxel, relative to the
    // first voxel of origin_block.
    TESSERA_HD_MEMBER static void GatherCorners(const SdfArguments& a, const Int* voxel,
                                                const Mask& wanted, Int* words) {
        Int block[3], index[8];
        for (int k = 0; k < 3; ++k) block[k] = voxel[k] >> 3;
        BlockKernels<V>::CornerVoxels(a, HashedBlocks<V>().Find(a, block, wanted), voxel, index);
        for (int c = 0; c < 8; ++c) words[c] = V::AsInt(V::Gather(a.field, index[c]));
    }

    TESSERA_HD_MEMBER static void Add(Real* sums, int at, const Real& v) {
        sums[at] = sums[at] + v;
    }

    TESSERA_HD_MEMBER static Real Masked(const Mask& m, const Real& v) {
        return V::Select(m, v, Real(0.0f));
    }

    TESSERA_HD_MEMBER static void StoreResidual(float* target, int i, const Mask& valid,
                                                const Real& r) {
        if (target == nullptr) return;
        V::Store(V::Select(valid, r, Real(std::numeric_limits<float>::quiet_NaN())), target + i);
    }

    // The geometric half of [B14] eq. 10: r = psi(p).
    TESSERA_HD_MEMBER static void AddDistance(const SdfArguments& a, int i, const Real* p,
                                              const Real* fraction, const Int* words,
                                              const Mask& known, const Real& point_weight,
                                              Real* sums) {
        Real corner[8];
        for (int c = 0; c < 8; ++c) corner[c] = V::ToReal(words[c] >> 16);
        const auto s = Trilinear(corner, fraction[0], fraction[1], fraction[2]);
        const Real to_m(a.truncation_m / kDistanceSteps),
            slope(a.truncation_m / (kDistanceSteps * a.voxel_size_m));
        // A distance measured along a slanted ray is too long, and so is its gradient: divide by
        // the gradient's length.
        Real steepness(1.0f);
        if (a.normalise)
            steepness =
                Real(1.0f) /
                V::Max(Real(1.0f), V::Sqrt(s.gx * s.gx + s.gy * s.gy + s.gz * s.gz) * slope);
        const Real residual = s.value * to_m * steepness;
        const Real g[3] = {s.gx * slope * steepness, s.gy * slope * steepness,
                           s.gz * slope * steepness};
        const Real scale(a.distance_scale_m);
        const Real w = Masked(known, point_weight * HuberWeight(residual, scale));
        Real j[6];
        PointJacobian(p, g, j);
        AddPoseTerm(j, residual, w, sums + L::kDistance);
        Add(sums, L::kDistanceError, w * residual * residual);
        Add(sums, L::kDistanceWeight, w);
        const Mask counted = known && (point_weight > Real(0.0f));
        Add(sums, L::kKnown, Masked(counted, Real(1.0f)));
        Add(sums, L::kInliers,
            Masked(counted && (V::Abs(residual) < Real(a.inlier_distance_m)), Real(1.0f)));
        StoreResidual(a.distance_residual, i, counted, residual);
        if (a.distance_residual == nullptr) return;
        for (int k = 0; k < 3; ++k) V::Store(g[k], a.gradient[k] + i);
    }

    // The photometric half: r = psi_I(p) - (gain * image + offset).
    TESSERA_HD_MEMBER static void AddIntensity(const SdfArguments& a, int i, const Real* p,
                                               const Real* fraction, const Int* words, Mask known,
                                               const Real& point_weight, Real* sums) {
        Real corner[8];
        for (int c = 0; c < 8; ++c) {
            const Int intensity = words[c] & Int(0xffff);
            known = known && V::ToMask(intensity != Int(0));
            corner[c] = V::ToReal(intensity);
        }
        const Real image = V::Load(a.intensity + i);
        known = known && (image >= Real(0.0f)) && (point_weight > Real(0.0f));
        if (V::Any(known)) {
            const auto s = Trilinear(corner, fraction[0], fraction[1], fraction[2]);
            const Real to_one(1.0f / kIntensitySteps),
                slope(1.0f / (kIntensitySteps * a.voxel_size_m));
            const Real residual =
                (s.value - Real(1.0f)) * to_one - (Real(a.gain) * image + Real(a.offset));
            const Real g[3] = {s.gx * slope, s.gy * slope, s.gz * slope};
            const Real w =
                Masked(known, point_weight * HuberWeight(residual, Real(a.intensity_scale)));
            Real j[6];
            PointJacobian(p, g, j);
            AddPoseTerm(j, residual, w, sums + L::kIntensity);
            AddBrightnessTerm(j, residual, image, w, sums);
            Add(sums, L::kIntensityError, w * residual * residual);
            Add(sums, L::kIntensityWeight, w);
            Add(sums, L::kColoured, Masked(known, Real(1.0f)));
            StoreResidual(a.intensity_residual, i, known, residual);
        } else {
            StoreResidual(a.intensity_residual, i, known, Real(0.0f));
        }
    }
};

}  // namespace tessera
