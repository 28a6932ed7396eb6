// The prealignment's sums: what one point of the last image contributes, by its intensity and its
// depth in the newest image. AlignKernels works on lanes of points (scalar_lanes.h).
#pragma once

#include "core/scalar_ops.h"
#include "tracking/align_arguments.h"
#include "tracking/normal_equations.h"
#include "tracking/view_kernels.h"

namespace tessera {

template <class V>
class AlignKernels {
  public:
    using Real = typename V::Real;
    using Mask = typename V::Mask;

    // Adds the contributions of points [i, i + V::kCount) to sums[], laid out as SumLayout with an
    // offset but no gain. Weights are Huber weights over the squared scale. kDistanceError holds
    // the sum of min((r / scale)^2, 4) over both kinds of residuals, kKnown their number.
    TESSERA_HD_MEMBER static void AddPoints(const AlignArguments& a, int i, Real* sums) {
        const Projected<V> q = Project<V>(a, i);
        const Real z = V::Load(a.z + i), last = V::Load(a.intensity_of_point + i);
        const Mask known = q.inside && (z > Real(0.0f));
        Real g[3], j[6];

        const ViewSample<V> colour = SampleAt<V>(a.intensity, a.width, a.height, q);
        ImageGradientInSpace(q.p, Real(a.fx), Real(a.fy), colour.du, colour.dv, g);
        PointJacobian(q.p, g, j);
        Residual(j, colour.value - (last + Real(a.offset)),
                 known && (last >= Real(0.0f)) && (colour.least >= Real(0.0f)),
                 Real(a.intensity_scale), Real(-1.0f), sums);

        const ViewSample<V> depth = SampleAt<V>(a.depth, a.width, a.height, q);
        const Real error = depth.value - q.p[2];
        ImageGradientInSpace(q.p, Real(a.fx), Real(a.fy), depth.du, depth.dv, g);
        g[2] = g[2] - Real(1.0f);
        PointJacobian(q.p, g, j);
        Residual(j, error,
                 known && (depth.least >= Real(0.05f)) && (V::Abs(error) <= Real(a.depth_gate_m)),
                 Real(a.depth_scale_m) * V::Max(Real(1.0f), z), Real(0.0f), sums);
    }

  private:
    using L = SumLayout;

    TESSERA_HD_MEMBER static void Add(Real* sums, int at, const Real& v) {
        sums[at] = sums[at] + v;
    }

    // `by_offset`: d(residual)/d(offset).
    TESSERA_HD_MEMBER static void Residual(const Real* j, const Real& error, const Mask& valid,
                                           const Real& scale, const Real& by_offset, Real* sums) {
        const Real r = V::Select(valid, error, Real(0.0f)), in_scales = r / scale;
        const Real w = V::Select(valid, HuberWeight(r, scale) / (scale * scale), Real(0.0f));
        AddPoseTerm(j, r, w, sums);
        const Real wo = w * by_offset;
        for (int row = 0; row < 6; ++row) Add(sums, L::kCoupling + 2 * row + 1, wo * j[row]);
        Add(sums, L::kBrightness + 2, wo * by_offset);
        Add(sums, L::kBrightnessGradient + 1, wo * r);
        Add(sums, L::kDistanceError, V::Min(in_scales * in_scales, Real(4.0f)));
        Add(sums, L::kKnown, V::Select(valid, Real(1.0f), Real(0.0f)));
    }
};

}  // namespace tessera
