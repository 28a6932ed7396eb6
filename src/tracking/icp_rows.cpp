#include "tracking/icp_rows.h"

#include <limits>

#include "core/vector_types.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {
namespace {

using L = SumLayout;
static_assert(kPointPadding % kLanes == 0);

struct Sums {
    Real value[L::kCount];
};

[[gnu::always_inline]] inline void Add(Sums& s, int at, const Real& v) { s.value[at] = s.value[at] + v; }

[[gnu::always_inline]] inline Real Masked(const RealMask& m, const Real& v) { return Select(m, v, Real(0.0f)); }

// Stores the residuals and adds their energy and the energy before where both exist.
[[gnu::always_inline]] inline void AddEnergy(float* target, const float* before, int i, const RealMask& valid,
                                             const Real& residual, const Real& scale, const Real& weight, Sums& sums) {
    Select(valid, residual, Real(std::numeric_limits<float>::quiet_NaN())).store_unaligned(target + i);
    const Real cost = weight * HuberCost(residual, scale);
    if (before == nullptr) return Add(sums, L::kEnergy, Masked(valid, cost));
    const Real old = Load(before + i);
    const RealMask both = valid & (old == old);
    Add(sums, L::kEnergy, Masked(both, cost));
    Add(sums, L::kEnergyBefore, Masked(both, weight * HuberCost(old, scale)));
}

[[gnu::always_inline]] inline void Rotate(const float* rotation, const Real& x, const Real& y, const Real& z, Real* out) {
    for (int k = 0; k < 3; ++k) {
        const float* r = rotation + 3 * k;
        out[k] = Real(r[0]) * x + Real(r[1]) * y + Real(r[2]) * z;
    }
}

// Points in the view's frame and where they fall in its image.
struct Projected {
    Real p[3];
    Real u, v;
    RealMask inside;  // in front of the camera and within the image
};

[[gnu::always_inline]] inline Projected Project(const IcpArguments& a, int i) {
    Projected q;
    Rotate(a.rotation, Load(a.x + i), Load(a.y + i), Load(a.z + i), q.p);
    for (int k = 0; k < 3; ++k) q.p[k] = q.p[k] + Real(a.translation[k]);
    const RealMask in_front = q.p[2] > Real(0.05f);
    q.p[2] = Select(in_front, q.p[2], Real(1.0f));
    const Real inverse_z = Real(1.0f) / q.p[2];
    q.u = q.p[0] * inverse_z * Real(a.fx) + Real(a.cx);
    q.v = q.p[1] * inverse_z * Real(a.fy) + Real(a.cy);
    q.inside = in_front & (q.u >= Real(0.0f)) & (q.v >= Real(0.0f)) & (q.u <= Real(static_cast<float>(a.width - 1))) &
               (q.v <= Real(static_cast<float>(a.height - 1)));
    q.u = Masked(q.inside, q.u);
    q.v = Masked(q.inside, q.v);
    return q;
}

// [D18] eq. 17-18: the residual to the tangent plane of the pixel's surface. Returns where there is a partner.
[[gnu::always_inline]] inline RealMask AddDistance(const IcpArguments& a, int i, const Projected& q, const Real& weight,
                                                   Sums& sums) {
    const Real u = xsimd::floor(q.u + Real(0.5f)), v = xsimd::floor(q.v + Real(0.5f));
    const Int pixel = xsimd::to_int(v) * Int(a.width) + xsimd::to_int(u);
    const Real depth = Gather(a.depth, pixel);
    const Int at = pixel + pixel + pixel;
    const Real n[3] = {Gather(a.normal, at), Gather(a.normal + 1, at), Gather(a.normal + 2, at)};
    const Real d[3] = {q.p[0] - (u - Real(a.cx)) * Real(1.0f / a.fx) * depth,
                       q.p[1] - (v - Real(a.cy)) * Real(1.0f / a.fy) * depth, q.p[2] - depth};
    Real normal[3];
    Rotate(a.rotation, Load(a.normal_x + i), Load(a.normal_y + i), Load(a.normal_z + i), normal);
    const RealMask counts = weight > Real(0.0f);
    const RealMask known = counts & q.inside & (depth > Real(0.0f));
    const RealMask matched = known &
                             (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < Real(a.distance_gate_m * a.distance_gate_m)) &
                             (normal[0] * n[0] + normal[1] * n[1] + normal[2] * n[2] > Real(a.normal_gate_cosine));
    const Real residual = Masked(matched, d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
    const Real scale(a.distance_scale_m);
    const Real w = Masked(matched, weight * HuberWeight(residual, scale));
    Real j[6];
    PointJacobian(q.p, n, j);
    AddPoseTerm(j, residual, w, sums.value);
    Add(sums, L::kDistanceError, w * residual * residual);
    Add(sums, L::kDistanceWeight, w);
    Add(sums, L::kKnown, Masked(known, Real(1.0f)));
    Add(sums, L::kInliers, Masked(matched & (xsimd::abs(residual) < Real(a.inlier_distance_m)), Real(1.0f)));
    AddEnergy(a.distance_residual, a.distance_before, i, matched, residual, scale, weight, sums);
    return matched;
}

// The same pixel's colour: r = predicted(projection of p) - (gain * image + offset).
[[gnu::always_inline]] inline void AddIntensity(const IcpArguments& a, int i, const Projected& q, const RealMask& matched,
                                                const Real& weight, Sums& sums) {
    const Real u0 = xsimd::min(xsimd::floor(q.u), Real(static_cast<float>(a.width - 2)));
    const Real v0 = xsimd::min(xsimd::floor(q.v), Real(static_cast<float>(a.height - 2)));
    const Int pixel = xsimd::to_int(v0) * Int(a.width) + xsimd::to_int(u0);
    const Int below = pixel + Int(a.width);
    const Real p00 = Gather(a.intensity, pixel), p10 = Gather(a.intensity + 1, pixel);
    const Real p01 = Gather(a.intensity, below), p11 = Gather(a.intensity + 1, below);
    const Real image = Load(a.intensity_of_point + i);
    const RealMask counts = (weight > Real(0.0f)) & (image >= Real(0.0f));
    const auto s = Bilinear(p00, p10, p01, p11, q.u - u0, q.v - v0);
    const Real raw = s.value - (Real(a.gain) * image + Real(a.offset));
    const Real gate(a.intensity_gate), scale(a.intensity_scale);
    const RealMask valid = counts & matched & (xsimd::min(xsimd::min(p00, p10), xsimd::min(p01, p11)) >= Real(0.0f)) &
                           (xsimd::abs(raw) < gate);
    const Real residual = Masked(valid, raw);
    const Real w = Masked(valid, weight * HuberWeight(residual, scale));
    const Real weighted = w * Real(a.alpha);
    Real g[3], j[6];
    ImageGradientInSpace(q.p, Real(a.fx), Real(a.fy), s.du, s.dv, g);
    PointJacobian(q.p, g, j);
    AddPoseTerm(j, residual, weighted, sums.value);
    AddBrightnessTerm(j, residual, image, weighted, sums.value);
    Add(sums, L::kIntensityError, w * residual * residual);
    Add(sums, L::kIntensityWeight, w);
    Add(sums, L::kColoured, Masked(valid, Real(1.0f)));
    AddEnergy(a.intensity_residual, a.intensity_before, i, valid, residual, scale, weight * Real(a.alpha), sums);
}

}  // namespace

void SumIcpPoints(const IcpArguments& a, int first, int last, double* sums) {
    Sums lanes;
    for (Real& value : lanes.value) value = Real(0.0f);
    for (int i = first; i < last; i += kLanes) {
        const Real weight = Load(a.weight + i);
        const Projected q = Project(a, i);
        const RealMask matched = AddDistance(a, i, q, weight, lanes);
        if (a.alpha > 0.0f) AddIntensity(a, i, q, matched, weight, lanes);
    }
    for (int k = 0; k < L::kCount; ++k) sums[k] += static_cast<double>(xsimd::hadd(lanes.value[k]));
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
