// A bumpy wall seen by a small camera, and the sums of ICP over its points, one point at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/se3.h"
#include "tracking/icp_kernels.h"
#include "tracking/pose_solver.h"
#include "tracking/set_view.h"

namespace tessera::testing_support {

inline float Random(std::uint32_t& state) {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / static_cast<float>(1 << 24);
}

// A bumpy wall seen by a small camera, with holes and pixels without colour, and points near it.
struct Scene {
    static constexpr int kWidth = 40, kHeight = 30, kPoints = 2048;
    std::vector<float> depth, normal, intensity;
    std::vector<float> x, y, z, nx, ny, nz, image, weight, distance_residual, intensity_residual,
        gradient[3];
    IcpArguments a{};

    Scene() {
        std::uint32_t state = 7;
        for (int i = 0; i < kWidth * kHeight; ++i) {
            const float u = static_cast<float>(i % kWidth), v = static_cast<float>(i / kWidth);
            depth.push_back(i % 31 == 0 ? 0.0f
                                        : 1.5f + 0.05f * std::sin(0.3f * u) * std::cos(0.2f * v));
            const Eigen::Vector3f n =
                Eigen::Vector3f(0.3f * Random(state) - 0.15f, 0.2f * Random(state), -1)
                    .normalized();
            normal.insert(normal.end(), {n.x(), n.y(), n.z()});
            intensity.push_back(i % 41 == 0 ? -1.0f : 0.5f + 0.4f * std::sin(0.5f * u - 0.4f * v));
        }
        for (int i = 0; i < kPoints; ++i) {
            const float far = 1.4f + 0.3f * Random(state);
            x.push_back((Random(state) - 0.5f) * 1.6f);
            y.push_back((Random(state) - 0.5f) * 1.2f);
            z.push_back(i % 97 == 0 ? -far : far);
            const Eigen::Vector3f n =
                Eigen::Vector3f(Random(state) - 0.5f, Random(state) - 0.5f, -1).normalized();
            nx.push_back(n.x());
            ny.push_back(n.y());
            nz.push_back(n.z());
            image.push_back(i % 7 == 0 ? -1.0f : Random(state));
            weight.push_back(i % 5 == 0 ? 0.0f : 0.5f + Random(state));
        }
        distance_residual.resize(kPoints);
        for (auto& values : gradient) values.resize(kPoints);
        intensity_residual.resize(kPoints);
        SetCamera({kWidth, kHeight, 38, 39, 18.5, 15.25}, a);
        a.depth = depth.data();
        a.normal = normal.data();
        a.intensity = intensity.data();
        a.x = x.data();
        a.y = y.data();
        a.z = z.data();
        a.normal_x = nx.data();
        a.normal_y = ny.data();
        a.normal_z = nz.data();
        a.intensity_of_point = image.data();
        a.weight = weight.data();
        a.distance_gate_m = 0.08f;
        a.normal_gate_cosine = 0.9f;
        a.distance_scale_m = 0.02f;
        a.intensity_scale = 0.1f;
        a.intensity_gate = 0.5f;
        a.gain = 1.1f;
        a.offset = -0.03f;
        a.band = {0.04f, 0.02f, 0.1f};
        a.distance_residual = distance_residual.data();
        a.intensity_residual = intensity_residual.data();
        for (std::size_t k = 0; k < 3; ++k) a.gradient[k] = gradient[k].data();
        Vector6d twist;
        twist << 0.01, -0.02, 0.03, 0.02, 0.01, -0.01;
        SetPose(Se3Exp(twist), a);
    }
};

// Reference for the sums: one point at a time, in double precision.
class SlowIcpSums {
  public:
    explicit SlowIcpSums(const Scene& scene) : s_(scene), a_(scene.a) {
        for (int i = 0; i < Scene::kPoints; ++i)
            if (s_.weight[static_cast<std::size_t>(i)] > 0) AddPoint(static_cast<std::size_t>(i));
    }
    PoseSums sums;

  private:
    using L = SumLayout;

    Eigen::Vector3d Rotated(float x, float y, float z) const {
        const float* r = a_.rotation;
        return {r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z,
                r[6] * x + r[7] * y + r[8] * z};
    }

    void AddPoint(std::size_t i) {
        const Eigen::Vector3d p =
            Rotated(s_.x[i], s_.y[i], s_.z[i]) +
            Eigen::Vector3d(a_.translation[0], a_.translation[1], a_.translation[2]);
        if (p.z() <= 0.05) return;
        const double u = p.x() / p.z() * a_.fx + a_.cx, v = p.y() / p.z() * a_.fy + a_.cy;
        if (u < 0 || v < 0 || u > a_.width - 1 || v > a_.height - 1) return;
        const int pu = static_cast<int>(std::floor(u + 0.5)),
                  pv = static_cast<int>(std::floor(v + 0.5));
        const auto pixel = static_cast<std::size_t>(pv * a_.width + pu);
        const double depth = a_.depth[pixel];
        if (depth <= 0) return;
        sums.value[L::kKnown] += 1;
        const double cx = a_.cx, cy = a_.cy;
        const Eigen::Vector3d surface((pu - cx) / a_.fx * depth, (pv - cy) / a_.fy * depth, depth);
        const Eigen::Vector3d n(a_.normal[3 * pixel], a_.normal[3 * pixel + 1],
                                a_.normal[3 * pixel + 2]);
        const Eigen::Vector3d normal = Rotated(s_.nx[i], s_.ny[i], s_.nz[i]);
        if ((p - surface).norm() >= a_.distance_gate_m || normal.dot(n) <= a_.normal_gate_cosine)
            return;
        const double r = n.dot(p - surface);
        const double band = std::clamp(0.02 * a_.z[i] * a_.z[i], 0.04, 0.1);
        const double w =
            s_.weight[i] * std::min(1.0, static_cast<double>(a_.distance_scale_m) / std::abs(r));
        sums.value[L::kBand] += w * band * band;
        sums.value[L::kInliers] += std::abs(r) < 0.5 * band;
        Add(p, n, r, s_.weight[i], a_.distance_scale_m, L::kDistanceError, L::kDistanceWeight, 1.0,
            L::kDistance);
        if (a_.alpha <= 0 || s_.image[i] < 0) return;
        AddIntensity(i, p, u, v);
    }

    void AddIntensity(std::size_t i, const Eigen::Vector3d& p, double u, double v) {
        const int u0 = std::min(static_cast<int>(u), a_.width - 2),
                  v0 = std::min(static_cast<int>(v), a_.height - 2);
        const auto at = [&](int du, int dv) {
            return static_cast<double>(a_.intensity[(v0 + dv) * a_.width + u0 + du]);
        };
        if (std::min({at(0, 0), at(1, 0), at(0, 1), at(1, 1)}) < 0) return;
        const auto s = Bilinear<double>(at(0, 0), at(1, 0), at(0, 1), at(1, 1), u - u0, v - v0);
        const double r = s.value - (a_.gain * s_.image[i] + a_.offset);
        if (std::abs(r) >= a_.intensity_gate) return;
        const double point[3] = {p.x(), p.y(), p.z()};
        double g[3];
        ImageGradientInSpace<double>(point, a_.fx, a_.fy, s.du, s.dv, g);
        sums.value[L::kColoured] += 1;
        const double w = Add(p, {g[0], g[1], g[2]}, r, s_.weight[i], a_.intensity_scale,
                             L::kIntensityError, L::kIntensityWeight, a_.alpha, L::kIntensity);
        double j[6];
        PointJacobian(point, g, j);
        AddBrightnessTerm(j, r, double(s_.image[i]), w, sums.value);
    }

    double Add(const Eigen::Vector3d& p, const Eigen::Vector3d& g, double r, double weight,
               double scale, int error, int total, double share, int term) {
        const double point[3] = {p.x(), p.y(), p.z()}, gradient[3] = {g.x(), g.y(), g.z()};
        double j[6];
        PointJacobian(point, gradient, j);
        const double w = weight * std::min(1.0, scale / std::abs(r));
        AddPoseTerm(j, r, w, sums.value + term);
        sums.value[error] += w * r * r;
        sums.value[total] += w;
        const double size = std::abs(r);
        sums.value[L::kEnergy] +=
            share * weight * (size < scale ? r * r : scale * (2 * size - scale));
        return w;
    }

    const Scene& s_;
    const IcpArguments& a_;
};

}  // namespace tessera::testing_support
