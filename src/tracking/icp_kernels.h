// The ICP tracker's sums: one point's contribution to [D18] eq. 17 and to the photometric term.
// Formulas that normal_equations.h does not have are templates on the number type. IcpKernels
// combines them for lanes of points (scalar_lanes.h), for the CPU's SIMD kernels and CUDA.
#pragma once

#include <limits>

#include "core/scalar_ops.h"
#include "tracking/icp_arguments.h"
#include "tracking/normal_equations.h"
#include "tracking/view_kernels.h"

namespace tessera {

// Huber's cost: r^2 up to the scale, then scale (2 |r| - scale). HuberWeight is its IRLS weight.
template <class F>
TESSERA_HD F HuberCost(const F& residual, const F& scale) {
    const F size = abs(residual);
    const F inner = min(size, scale);
    return inner * (size + size - inner);
}

// The sums for lanes V of points.
template <class V>
class IcpKernels {
  public:
    using Real = typename V::Real;
    using Int = typename V::Int;
    using Mask = typename V::Mask;

    // Adds the contributions of points [i, i + V::kCount) to sums[], laid out as SumLayout, and
    // writes their residuals.
    TESSERA_HD_MEMBER static void AddPoints(const IcpArguments& a, int i, Real* sums) {
        const Real weight = V::Load(a.weight + i);
        const Projected<V> q = Project<V>(a, i);
        const Mask matched = AddDistance(a, i, q, weight, sums);
        if (a.alpha > 0.0f) AddIntensity(a, i, q, matched, weight, sums);
    }

  private:
    using L = SumLayout;

    TESSERA_HD_MEMBER static void Add(Real* sums, int at, const Real& v) {
        sums[at] = sums[at] + v;
    }

    TESSERA_HD_MEMBER static Real Masked(const Mask& m, const Real& v) {
        return V::Select(m, v, Real(0.0f));
    }

    // Stores the residuals. Adds their energy and the previous energy, where both exist.
    TESSERA_HD_MEMBER static void AddEnergy(float* target, const float* before, int i,
                                            const Mask& valid, const Real& residual,
                                            const Real& scale, const Real& weight, Real* sums) {
        V::Store(V::Select(valid, residual, Real(std::numeric_limits<float>::quiet_NaN())),
                 target + i);
        const Real cost = weight * HuberCost(residual, scale);
        if (before == nullptr) return Add(sums, L::kEnergy, Masked(valid, cost));
        const Real old = V::Load(before + i);
        const Mask both = valid && (old == old);
        Add(sums, L::kEnergy, Masked(both, cost));
        Add(sums, L::kEnergyBefore, Masked(both, weight * HuberCost(old, scale)));
    }

    // [D18] eq. 17-18: the point-to-plane residual at the associated pixel. Returns which points
    // have an association.
    TESSERA_HD_MEMBER static Mask AddDistance(const IcpArguments& a, int i, const Projected<V>& q,
                                              const Real& weight, Real* sums) {
        const Real u = V::Floor(q.u + Real(0.5f)), v = V::Floor(q.v + Real(0.5f));
        const Int pixel = V::ToInt(v) * Int(a.width) + V::ToInt(u);
        const Real depth = V::Gather(a.depth, pixel);
        const Int at = pixel + pixel + pixel;
        const Real n[3] = {V::Gather(a.normal, at), V::Gather(a.normal + 1, at),
                           V::Gather(a.normal + 2, at)};
        const Real d[3] = {q.p[0] - (u - Real(a.cx)) * Real(1.0f / a.fx) * depth,
                           q.p[1] - (v - Real(a.cy)) * Real(1.0f / a.fy) * depth, q.p[2] - depth};
        Real normal[3];
        Rotate<V>(a.rotation, V::Load(a.normal_x + i), V::Load(a.normal_y + i),
                  V::Load(a.normal_z + i), normal);
        const Mask counts = weight > Real(0.0f);
        const Mask known = counts && q.inside && (depth > Real(0.0f));
        const Mask matched =
            known &&
            (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <
             Real(a.distance_gate_m * a.distance_gate_m)) &&
            (normal[0] * n[0] + normal[1] * n[1] + normal[2] * n[2] > Real(a.normal_gate_cosine));
        const Real residual = Masked(matched, d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
        const Real scale(a.distance_scale_m);
        const Real w = Masked(matched, weight * HuberWeight(residual, scale));
        Real j[6];
        PointJacobian(q.p, n, j);
        AddPoseTerm(j, residual, w, sums + L::kDistance);
        for (int k = 0; k < 3; ++k) V::Store(n[k], a.gradient[k] + i);
        Add(sums, L::kDistanceError, w * residual * residual);
        Add(sums, L::kDistanceWeight, w);
        const Real band = a.band.At(V::Load(a.z + i));
        Add(sums, L::kBand, w * band * band);
        Add(sums, L::kKnown, Masked(known, Real(1.0f)));
        Add(sums, L::kInliers,
            Masked(matched && (V::Abs(residual) < Real(0.5f) * band), Real(1.0f)));
        AddEnergy(a.distance_residual, a.distance_before, i, matched, residual, scale, weight,
                  sums);
        return matched;
    }

    // The photometric residual: r = predicted(projection of p) - (gain * image + offset).
    TESSERA_HD_MEMBER static void AddIntensity(const IcpArguments& a, int i, const Projected<V>& q,
                                               const Mask& matched, const Real& weight,
                                               Real* sums) {
        const ViewSample<V> s = SampleAt<V>(a.intensity, a.width, a.height, q);
        const Real image = V::Load(a.intensity_of_point + i);
        const Mask counts = (weight > Real(0.0f)) && (image >= Real(0.0f));
        const Real raw = s.value - (Real(a.gain) * image + Real(a.offset));
        const Real gate(a.intensity_gate), scale(a.intensity_scale);
        const Mask valid = counts && matched && (s.least >= Real(0.0f)) && (V::Abs(raw) < gate);
        const Real residual = Masked(valid, raw);
        const Real w = Masked(valid, weight * HuberWeight(residual, scale));
        Real g[3], j[6];
        ImageGradientInSpace(q.p, Real(a.fx), Real(a.fy), s.du, s.dv, g);
        PointJacobian(q.p, g, j);
        AddPoseTerm(j, residual, w, sums + L::kIntensity);
        AddBrightnessTerm(j, residual, image, w, sums);
        Add(sums, L::kIntensityError, w * residual * residual);
        Add(sums, L::kIntensityWeight, w);
        Add(sums, L::kColoured, Masked(valid, Real(1.0f)));
        AddEnergy(a.intensity_residual, a.intensity_before, i, valid, residual, scale,
                  weight * Real(a.alpha), sums);
    }
};

}  // namespace tessera
