#include "tracking/icp_simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/cpu.h"
#include "core/se3.h"
#include "tracking/icp_kernels.h"
#include "tracking/one_by_one.h"
#include "tracking/pose_solver.h"
#include "tracking/set_view.h"

namespace tessera {
namespace {

using L = SumLayout;

float Random(std::uint32_t& state) {
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

using SumFunction = void (*)(const IcpArguments&, int, int, double*);

std::vector<SumFunction> Paths() {
    std::vector<SumFunction> paths = {baseline::SumIcpPoints};
    if (CpuHasAvx2()) paths.push_back(avx2::SumIcpPoints);
    return paths;
}

class IcpRows : public testing::TestWithParam<float> {};

TEST_P(IcpRows, AgreeWithTheSlowSums) {
    Scene scene;
    scene.a.alpha = GetParam();
    const PoseSums slow = SlowIcpSums(scene).sums;
    ASSERT_GT(slow[L::kInliers], 100);
    ASSERT_EQ(slow[L::kColoured] > 100, GetParam() > 0);
    for (const SumFunction sum : Paths()) {
        PoseSums sums;
        sum(scene.a, 0, Scene::kPoints, sums.value);
        for (int k = 0; k < L::kCount; ++k)
            EXPECT_NEAR(sums[k], slow[k], 2e-4 * (1.0 + std::abs(slow[k]))) << "sum " << k;
        const auto partners =
            std::count_if(scene.distance_residual.begin(), scene.distance_residual.end(),
                          [](float r) { return !std::isnan(r); });
        EXPECT_GT(slow[L::kKnown], partners);
    }
}

// Every SIMD lane gives the same bytes as the kernel applied to one point at a time.
TEST_P(IcpRows, AreTheKernelsOneByOne) {
    Scene expected;
    expected.a.alpha = GetParam();
    PoseSums one_by_one;
    testing_support::SumOneByOne<IcpKernels<ScalarLanes>>(expected.a, 0, Scene::kPoints,
                                                          one_by_one.value);
    for (const SumFunction sum : Paths()) {
        Scene scene;
        scene.a.alpha = GetParam();
        PoseSums sums;
        sum(scene.a, 0, Scene::kPoints, sums.value);
        const std::size_t bytes = Scene::kPoints * sizeof(float);
        EXPECT_EQ(
            std::memcmp(scene.distance_residual.data(), expected.distance_residual.data(), bytes),
            0);
        EXPECT_EQ(
            std::memcmp(scene.intensity_residual.data(), expected.intensity_residual.data(), bytes),
            0);
        EXPECT_EQ(std::memcmp(sums.value, one_by_one.value, sizeof sums.value), 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Alpha, IcpRows, testing::Values(0.0f, 0.1f));

// The energies of two poses include only residuals that exist at both.
TEST(IcpRows, EnergiesOfTwoPosesAreOverTheSamePoints) {
    for (const SumFunction sum : Paths()) {
        Scene here;
        here.a.alpha = 0.1f;
        PoseSums at_first;
        sum(here.a, 0, Scene::kPoints, at_first.value);
        EXPECT_EQ(at_first[L::kEnergyBefore], 0);
        Scene there;
        there.a.alpha = 0.1f;
        Vector6d twist;
        twist << 0.02, 0.01, 0, 0.03, -0.02, 0.02;
        SetPose(Se3Exp(twist), there.a);
        there.a.distance_before = here.distance_residual.data();
        there.a.intensity_before = here.intensity_residual.data();
        PoseSums sums;
        sum(there.a, 0, Scene::kPoints, sums.value);
        double energy = 0, before = 0;
        const auto cost = [](float r, float scale) { return HuberCost(r, scale); };
        for (std::size_t i = 0; i < Scene::kPoints; ++i) {
            const float d0 = here.distance_residual[i], d1 = there.distance_residual[i];
            const float c0 = here.intensity_residual[i], c1 = there.intensity_residual[i];
            if (!std::isnan(d0) && !std::isnan(d1)) {
                before += here.weight[i] * cost(d0, 0.02f);
                energy += here.weight[i] * cost(d1, 0.02f);
            }
            if (!std::isnan(c0) && !std::isnan(c1)) {
                before += 0.1f * here.weight[i] * cost(c0, 0.1f);
                energy += 0.1f * here.weight[i] * cost(c1, 0.1f);
            }
        }
        EXPECT_NEAR(sums[L::kEnergy], energy, 1e-4 * energy);
        EXPECT_NEAR(sums[L::kEnergyBefore], before, 1e-4 * before);
        EXPECT_GT(at_first[L::kEnergy], before);
    }
}

// Checks d(residual)/d(increment) of both terms against central differences, with a fixed
// correspondence.
TEST(IcpKernels, JacobiansMatchCentralDifferences) {
    const Eigen::Vector3d p(0.21, -0.13, 1.4), n = Eigen::Vector3d(0.2, -0.3, -1).normalized(),
                                               partner(0.2, -0.1, 1.43);
    const double pixel[4] = {0.3, 0.5, 0.45, 0.2}, fx = 200, fy = 210;
    const auto sample = [&](const Eigen::Vector3d& q) {  // around the pixel onto which p projects
        const double u = fx * q.x() / q.z() - fx * p.x() / p.z() + 0.4,
                     v = fy * q.y() / q.z() - fy * p.y() / p.z() + 0.6;
        return Bilinear<double>(pixel[0], pixel[1], pixel[2], pixel[3], u, v);
    };
    const double point[3] = {p.x(), p.y(), p.z()}, plane[3] = {n.x(), n.y(), n.z()};
    double g[3], j_distance[6], j_intensity[6];
    PointJacobian(point, plane, j_distance);
    ImageGradientInSpace<double>(point, fx, fy, sample(p).du, sample(p).dv, g);
    PointJacobian(point, g, j_intensity);
    for (int k = 0; k < 6; ++k) {
        constexpr double kStep = 1e-6;
        Vector6d twist = Vector6d::Zero();
        twist(k) = kStep;
        const Eigen::Vector3d forward = Se3Exp(twist) * p, back = Se3Exp(-twist) * p;
        EXPECT_NEAR(j_distance[k], (n.dot(forward - partner) - n.dot(back - partner)) / (2 * kStep),
                    1e-8)
            << k;
        EXPECT_NEAR(j_intensity[k], (sample(forward).value - sample(back).value) / (2 * kStep),
                    1e-6)
            << k;
    }
}

TEST(IcpKernels, HuberCostJoinsItsPartsSmoothly) {
    EXPECT_FLOAT_EQ(HuberCost(0.01f, 0.02f), 1e-4f);
    EXPECT_FLOAT_EQ(HuberCost(-0.05f, 0.02f), 0.02f * (0.1f - 0.02f));
    EXPECT_NEAR(HuberCost(0.02001f, 0.02f), HuberCost(0.01999f, 0.02f), 1e-6f);
}

}  // namespace
}  // namespace tessera
