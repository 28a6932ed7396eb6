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
        Int index[8], words[8];
        CornerVoxels(a, cell, weight > Real(0.0f), index);
        for (int c = 0; c < 8; ++c) words[c] = V::AsInt(V::Gather(a.field, index[c]));
        // Unknown corners have the sentinel -32768 as distance.
        Int lowest = words[0] >> 16;
        for (int c = 1; c < 8; ++c) lowest = V::Min(lowest, words[c] >> 16);
        const Mask known = V::ToMask(lowest != Int(-32768));
        if (!V::Any(known)) {
            StoreResidual(a.distance_residual, i, known, Real(0.0f));
            StoreResidual(a.intensity_residual, i, known, Real(0.0f));
            return;
        }
        AddDistance(a, i, z, p, fraction, words, known, weight, sums);
        if (a.use_intensity) AddColour(a, i, p, fraction, index, words, known, weight, sums);
    }

  private:
    using L = SumLayout;

    // The voxels at the eight corners of cells, as indices of the map's layers. `voxel` is a cell's
    // lowest voxel, relative to the first voxel of origin_block.
    TESSERA_HD_MEMBER static void CornerVoxels(const SdfArguments& a, const Int* voxel,
                                               const Mask& wanted, Int* index) {
        Int block[3];
        for (int k = 0; k < 3; ++k) block[k] = voxel[k] >> 3;
        BlockKernels<V>::CornerVoxels(a, HashedBlocks<V>().Find(a, block, wanted), voxel, index);
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
    TESSERA_HD_MEMBER static void AddDistance(const SdfArguments& a, int i, const Real& depth,
                                              const Real* p, const Real* fraction, const Int* words,
                                              const Mask& known, const Real& point_weight,
                                              Real* sums) {
        Real corner[8];
        for (int c = 0; c < 8; ++c) corner[c] = V::ToReal(words[c] >> 16);
        const auto s = Trilinear(corner, fraction[0], fraction[1], fraction[2]);
        const Real to_m(a.band.most_m / kDistanceSteps),
            slope(a.band.most_m / (kDistanceSteps * a.voxel_size_m));
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
        const Real band = a.band.At(depth);
        Add(sums, L::kBand, w * band * band);
        const Mask counted = known && (point_weight > Real(0.0f));
        Add(sums, L::kKnown, Masked(counted, Real(1.0f)));
        Add(sums, L::kInliers,
            Masked(counted && (V::Abs(residual) < Real(0.5f) * band), Real(1.0f)));
        StoreResidual(a.distance_residual, i, counted, residual);
        if (a.distance_residual == nullptr) return;
        for (int k = 0; k < 3; ++k) V::Store(g[k], a.gradient[k] + i);
    }

    // A value of the map at points, minus the image's there, and its gradient.
    struct Photometric {
        Real residual, g[3], image;
    };

    // The photometric half: psi_I(p) - (gain * image + offset), and the same for chroma.
    TESSERA_HD_MEMBER static void AddColour(const SdfArguments& a, int i, const Real* p,
                                            const Real* fraction, const Int* index,
                                            const Int* words, Mask known, const Real& point_weight,
                                            Real* sums) {
        Real corner[8];
        for (int c = 0; c < 8; ++c) {
            const Int intensity = words[c] & Int(0xffff);
            known = known && V::ToMask(intensity != Int(0));
            corner[c] = V::ToReal(intensity);
        }
        const Real image = V::Load(a.intensity + i);
        known = known && (image >= Real(0.0f)) && (point_weight > Real(0.0f));
        if (!V::Any(known)) return StoreResidual(a.intensity_residual, i, known, Real(0.0f));
        const auto s = Trilinear(corner, fraction[0], fraction[1], fraction[2]);
        const Real to_one(1.0f / kIntensitySteps), slope(1.0f / (kIntensitySteps * a.voxel_size_m));
        const Photometric luma{
            (s.value - Real(1.0f)) * to_one - (Real(a.gain) * image + Real(a.offset)),
            {s.gx * slope, s.gy * slope, s.gz * slope},
            image};
        StoreResidual(a.intensity_residual, i, known, luma.residual);
        Real size = luma.residual;  // of [B14] eq. 6
        Photometric chroma[2];
        if (a.colour != nullptr) {
            ChromaResiduals(a, i, fraction, index, chroma);
            size = size * size;
            for (const Photometric& c : chroma) size = size + c.residual * c.residual;
            size = V::Sqrt(size);
        }
        const Real w = Masked(known, point_weight * HuberWeight(size, Real(a.intensity_scale)));
        Real j[6];
        PointJacobian(p, luma.g, j);
        AddPoseTerm(j, luma.residual, w, sums + L::kIntensity);
        AddBrightnessTerm(j, luma.residual, luma.image, w, sums);
        Add(sums, L::kIntensityError, w * luma.residual * luma.residual);
        Add(sums, L::kIntensityWeight, w);
        Add(sums, L::kColoured, Masked(known, Real(1.0f)));
        if (a.colour == nullptr) return;
        for (const Photometric& c : chroma) {
            PointJacobian(p, c.g, j);
            AddPoseTerm(j, c.residual, w, sums + L::kIntensity);
            AddGainTerm(j, c.residual, c.image, w, sums);
            Add(sums, L::kIntensityError, w * c.residual * c.residual);
        }
    }

    // The two residuals that make [B14] eq. 6 of the luma's: see ChromaWeights. Chroma has a gain
    // but no offset.
    TESSERA_HD_MEMBER static void ChromaResiduals(const SdfArguments& a, int i,
                                                  const Real* fraction, const Int* index,
                                                  Photometric* out) {
        using W = ChromaWeights;
        Real corner[2][8];
        for (int c = 0; c < 8; ++c) {
            const Int word = V::AsInt(V::Gather(a.colour, index[c]));
            const Real cb = V::ToReal(word & Int(1023)), cr = V::ToReal((word >> 10) & Int(1023));
            corner[0][c] = Real(W::kU) * cb + Real(W::kV) * cr;
            corner[1][c] = Real(W::kW) * cr;
        }
        const Real cb = V::Load(a.cb + i), cr = V::Load(a.cr + i);
        const Real image[2] = {Real(W::kU) * cb + Real(W::kV) * cr, Real(W::kW) * cr};
        const float zero[2] = {512.0f * (W::kU + W::kV), 512.0f * W::kW};
        const Real to_one(1.0f / kChromaSteps), slope(1.0f / (kChromaSteps * a.voxel_size_m));
        for (int k = 0; k < 2; ++k) {
            const auto s = Trilinear(corner[k], fraction[0], fraction[1], fraction[2]);
            out[k] = {(s.value - Real(zero[k])) * to_one - Real(a.gain) * image[k],
                      {s.gx * slope, s.gy * slope, s.gz * slope},
                      image[k]};
        }
    }
};

}  // namespace tessera
