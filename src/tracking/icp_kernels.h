// The ICP tracker's sums: one point's share of [D18] eq. 17 and of its photometric companion. The formulas beyond those
// of normal_equations.h are templates on the number type; IcpKernels puts them together for lanes of points
// (scalar_lanes.h), for the CPU's vectors and CUDA alike.
#pragma once

#include <limits>

#include "core/scalar_ops.h"
#include "tracking/icp_arguments.h"
#include "tracking/normal_equations.h"

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

// The sums of lanes V of points.
template <class V>
class IcpKernels {
  public:
    using Real = typename V::Real;
    using Int = typename V::Int;
    using Mask = typename V::Mask;

    // Adds what points [i, i + V::kCount) contribute to sums[], laid out as SumLayout, and writes their residuals.
    TESSERA_HD_MEMBER static void AddPoints(const IcpArguments& a, int i, Real* sums) {
        const Real weight = V::Load(a.weight + i);
        const Projected q = Project(a, i);
        const Mask matched = AddDistance(a, i, q, weight, sums);
        if (a.alpha > 0.0f) AddIntensity(a, i, q, matched, weight, sums);
    }

  private:
    using L = SumLayout;

    TESSERA_HD_MEMBER static void Add(Real* sums, int at, const Real& v) { sums[at] = sums[at] + v; }

    TESSERA_HD_MEMBER static Real Masked(const Mask& m, const Real& v) { return V::Select(m, v, Real(0.0f)); }

    // Stores the residuals and adds their energy and the energy before where both exist.
    TESSERA_HD_MEMBER static void AddEnergy(float* target, const float* before, int i, const Mask& valid,
                                            const Real& residual, const Real& scale, const Real& weight,
                                            Real* sums) {
        V::Store(V::Select(valid, residual, Real(std::numeric_limits<float>::quiet_NaN())), target + i);
        const Real cost = weight * HuberCost(residual, scale);
        if (before == nullptr) return Add(sums, L::kEnergy, Masked(valid, cost));
        const Real old = V::Load(before + i);
        const Mask both = valid && (old == old);
        Add(sums, L::kEnergy, Masked(both, cost));
        Add(sums, L::kEnergyBefore, Masked(both, weight * HuberCost(old, scale)));
    }

    TESSERA_HD_MEMBER static void Rotate(const float* rotation, const Real& x, const Real& y, const Real& z,
                                         Real* out) {
        for (int k = 0; k < 3; ++k) {
            const float* r = rotation + 3 * k;
            out[k] = Real(r[0]) * x + Real(r[1]) * y + Real(r[2]) * z;
        }
    }

    // Points in the view's frame and where they fall in its image.
    struct Projected {
        Real p[3];
        Real u, v;
        Mask inside;  // in front of the camera and within the image
    };

    TESSERA_HD_MEMBER static Projected Project(const IcpArguments& a, int i) {
        Projected q;
        Rotate(a.rotation, V::Load(a.x + i), V::Load(a.y + i), V::Load(a.z + i), q.p);
        for (int k = 0; k < 3; ++k) q.p[k] = q.p[k] + Real(a.translation[k]);
        const Mask in_front = q.p[2] > Real(0.05f);
        q.p[2] = V::Select(in_front, q.p[2], Real(1.0f));
        const Real inverse_z = Real(1.0f) / q.p[2];
        q.u = q.p[0] * inverse_z * Real(a.fx) + Real(a.cx);
        q.v = q.p[1] * inverse_z * Real(a.fy) + Real(a.cy);
        q.inside = in_front && (q.u >= Real(0.0f)) && (q.v >= Real(0.0f)) &&
                   (q.u <= Real(static_cast<float>(a.width - 1))) && (q.v <= Real(static_cast<float>(a.height - 1)));
        q.u = Masked(q.inside, q.u);
        q.v = Masked(q.inside, q.v);
        return q;
    }

    // [D18] eq. 17-18: the residual to the tangent plane of the pixel's surface. Returns where there is a partner.
    TESSERA_HD_MEMBER static Mask AddDistance(const IcpArguments& a, int i, const Projected& q, const Real& weight,
                                              Real* sums) {
        const Real u = V::Floor(q.u + Real(0.5f)), v = V::Floor(q.v + Real(0.5f));
        const Int pixel = V::ToInt(v) * Int(a.width) + V::ToInt(u);
        const Real depth = V::Gather(a.depth, pixel);
        const Int at = pixel + pixel + pixel;
        const Real n[3] = {V::Gather(a.normal, at), V::Gather(a.normal + 1, at), V::Gather(a.normal + 2, at)};
        const Real d[3] = {q.p[0] - (u - Real(a.cx)) * Real(1.0f / a.fx) * depth,
                           q.p[1] - (v - Real(a.cy)) * Real(1.0f / a.fy) * depth, q.p[2] - depth};
        Real normal[3];
        Rotate(a.rotation, V::Load(a.normal_x + i), V::Load(a.normal_y + i), V::Load(a.normal_z + i), normal);
        const Mask counts = weight > Real(0.0f);
        const Mask known = counts && q.inside && (depth > Real(0.0f));
        const Mask matched = known &&
                             (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < Real(a.distance_gate_m * a.distance_gate_m)) &&
                             (normal[0] * n[0] + normal[1] * n[1] + normal[2] * n[2] > Real(a.normal_gate_cosine));
        const Real residual = Masked(matched, d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
        const Real scale(a.distance_scale_m);
        const Real w = Masked(matched, weight * HuberWeight(residual, scale));
        Real j[6];
        PointJacobian(q.p, n, j);
        AddPoseTerm(j, residual, w, sums);
        Add(sums, L::kDistanceError, w * residual * residual);
        Add(sums, L::kDistanceWeight, w);
        Add(sums, L::kKnown, Masked(known, Real(1.0f)));
        Add(sums, L::kInliers, Masked(matched && (V::Abs(residual) < Real(a.inlier_distance_m)), Real(1.0f)));
        AddEnergy(a.distance_residual, a.distance_before, i, matched, residual, scale, weight, sums);
        return matched;
    }

    // The same pixel's colour: r = predicted(projection of p) - (gain * image + offset).
    TESSERA_HD_MEMBER static void AddIntensity(const IcpArguments& a, int i, const Projected& q, const Mask& matched,
                                               const Real& weight, Real* sums) {
        const Real u0 = V::Min(V::Floor(q.u), Real(static_cast<float>(a.width - 2)));
        const Real v0 = V::Min(V::Floor(q.v), Real(static_cast<float>(a.height - 2)));
        const Int pixel = V::ToInt(v0) * Int(a.width) + V::ToInt(u0);
        const Int below = pixel + Int(a.width);
        const Real p00 = V::Gather(a.intensity, pixel), p10 = V::Gather(a.intensity + 1, pixel);
        const Real p01 = V::Gather(a.intensity, below), p11 = V::Gather(a.intensity + 1, below);
        const Real image = V::Load(a.intensity_of_point + i);
        const Mask counts = (weight > Real(0.0f)) && (image >= Real(0.0f));
        const auto s = Bilinear(p00, p10, p01, p11, q.u - u0, q.v - v0);
        const Real raw = s.value - (Real(a.gain) * image + Real(a.offset));
        const Real gate(a.intensity_gate), scale(a.intensity_scale);
        const Mask valid = counts && matched && (V::Min(V::Min(p00, p10), V::Min(p01, p11)) >= Real(0.0f)) &&
                           (V::Abs(raw) < gate);
        const Real residual = Masked(valid, raw);
        const Real w = Masked(valid, weight * HuberWeight(residual, scale));
        const Real weighted = w * Real(a.alpha);
        Real g[3], j[6];
        ImageGradientInSpace(q.p, Real(a.fx), Real(a.fy), s.du, s.dv, g);
        PointJacobian(q.p, g, j);
        AddPoseTerm(j, residual, weighted, sums);
        AddBrightnessTerm(j, residual, image, weighted, sums);
        Add(sums, L::kIntensityError, w * residual * residual);
        Add(sums, L::kIntensityWeight, w);
        Add(sums, L::kColoured, Masked(valid, Real(1.0f)));
        AddEnergy(a.intensity_residual, a.intensity_before, i, valid, residual, scale, weight * Real(a.alpha), sums);
    }
};

}  // namespace tessera
