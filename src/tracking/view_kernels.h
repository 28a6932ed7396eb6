// Projects points into an image and samples the image there. Templates on the number type or on
// lanes V (scalar_lanes.h), for the CPU's SIMD kernels and CUDA.
#pragma once

#include "core/host_device.h"
#include "tracking/view_arguments.h"

namespace tessera {

// A sample between four pixels, (fu, fv) in [0, 1] from the first: value and slopes per pixel.
template <class F>
struct ImageSample {
    F value, du, dv;
};
template <class F>
TESSERA_HD ImageSample<F> Bilinear(const F& p00, const F& p10, const F& p01, const F& p11,
                                   const F& fu, const F& fv) {
    const F top = p00 + fu * (p10 - p00), bottom = p01 + fu * (p11 - p01);
    const F left = p10 - p00, right = p11 - p01;
    return {top + fv * (bottom - top), left + fv * (right - left), bottom - top};
}

// d(image)/d(point) where the point p (camera frame) projects into the image: slopes times the
// derivative of the projection.
template <class F>
TESSERA_HD void ImageGradientInSpace(const F* p, const F& fx, const F& fy, const F& du, const F& dv,
                                     F* g) {
    const F inverse_z = F(1.0f) / p[2];
    g[0] = du * fx * inverse_z;
    g[1] = dv * fy * inverse_z;
    g[2] = -(g[0] * p[0] + g[1] * p[1]) * inverse_z;
}

// Row-major rotation times (x, y, z).
template <class V>
TESSERA_HD void Rotate(const float* rotation, const typename V::Real& x, const typename V::Real& y,
                       const typename V::Real& z, typename V::Real* out) {
    for (int k = 0; k < 3; ++k) {
        const float* r = rotation + 3 * k;
        out[k] =
            typename V::Real(r[0]) * x + typename V::Real(r[1]) * y + typename V::Real(r[2]) * z;
    }
}

// Points in an image's camera frame and their projections.
template <class V>
struct Projected {
    typename V::Real p[3];
    typename V::Real u, v;    // 0 where outside
    typename V::Mask inside;  // in front of the camera and within the image
};

// Points [i, i + V::kCount).
template <class V>
TESSERA_HD Projected<V> Project(const ViewArguments& a, int i) {
    using Real = typename V::Real;
    Projected<V> q;
    Rotate<V>(a.rotation, V::Load(a.x + i), V::Load(a.y + i), V::Load(a.z + i), q.p);
    for (int k = 0; k < 3; ++k) q.p[k] = q.p[k] + Real(a.translation[k]);
    const typename V::Mask in_front = q.p[2] > Real(0.05f);
    q.p[2] = V::Select(in_front, q.p[2], Real(1.0f));
    const Real inverse_z = Real(1.0f) / q.p[2];
    q.u = q.p[0] * inverse_z * Real(a.fx) + Real(a.cx);
    q.v = q.p[1] * inverse_z * Real(a.fy) + Real(a.cy);
    q.inside = in_front && (q.u >= Real(0.0f)) && (q.v >= Real(0.0f)) &&
               (q.u <= Real(static_cast<float>(a.width - 1))) &&
               (q.v <= Real(static_cast<float>(a.height - 1)));
    q.u = V::Select(q.inside, q.u, Real(0.0f));
    q.v = V::Select(q.inside, q.v, Real(0.0f));
    return q;
}

// A sample of `image`, at least 2 x 2 pixels row by row, at (q.u, q.v), and the least of the four
// pixels around it.
template <class V>
struct ViewSample : ImageSample<typename V::Real> {
    typename V::Real least;
};
template <class V>
TESSERA_HD ViewSample<V> SampleAt(const float* image, int width, int height,
                                  const Projected<V>& q) {
    using Real = typename V::Real;
    using Int = typename V::Int;
    const Real u0 = V::Min(V::Floor(q.u), Real(static_cast<float>(width - 2)));
    const Real v0 = V::Min(V::Floor(q.v), Real(static_cast<float>(height - 2)));
    const Int pixel = V::ToInt(v0) * Int(width) + V::ToInt(u0);
    const Int below = pixel + Int(width);
    const Real p00 = V::Gather(image, pixel), p10 = V::Gather(image + 1, pixel);
    const Real p01 = V::Gather(image, below), p11 = V::Gather(image + 1, below);
    return {Bilinear(p00, p10, p01, p11, q.u - u0, q.v - v0),
            V::Min(V::Min(p00, p10), V::Min(p01, p11))};
}

}  // namespace tessera
