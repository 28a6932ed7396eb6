#include "tracking/align_simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <random>
#include <vector>

#include "core/cpu.h"
#include "core/se3.h"
#include "tracking/align_kernels.h"
#include "tracking/one_by_one.h"
#include "tracking/pose_solver.h"
#include "tracking/set_view.h"

namespace tessera {
namespace {

using L = SumLayout;
using SumAligned = void (*)(const AlignArguments&, int, int, double*);

// A wavy image with holes in depth and colour, and points near its surface.
struct TwoImages {
    static constexpr int kWidth = 40, kHeight = 30, kPoints = 1200;
    std::vector<float> depth, intensity, x, y, z, last;
    AlignArguments a{};

    TwoImages() {
        for (int i = 0; i < kWidth * kHeight; ++i) {
            const auto u = static_cast<float>(i % kWidth), v = static_cast<float>(i / kWidth);
            depth.push_back(i % 37 == 0 ? 0.0f
                                        : 1.5f + 0.1f * std::sin(0.4f * u) * std::cos(0.3f * v));
            intensity.push_back(i % 41 == 0 ? -1.0f : 0.5f + 0.4f * std::sin(0.5f * u - 0.4f * v));
        }
        std::mt19937 random(11);
        std::uniform_real_distribution<float> one;
        for (int i = 0; i < kPoints; ++i) {
            const float far = i % 53 == 0 ? 0.0f : i % 97 == 0 ? 1.9f : 1.4f + 0.2f * one(random);
            x.push_back((one(random) - 0.5f) * 1.7f);
            y.push_back((one(random) - 0.5f) * 1.3f);
            z.push_back(far);
            last.push_back(i % 7 == 0 ? -1.0f : one(random));
        }
        SetCamera({kWidth, kHeight, 38, 39, 19, 15.25}, a);
        SetPose(Pose(), a);
        a.depth = depth.data();
        a.intensity = intensity.data();
        a.x = x.data();
        a.y = y.data();
        a.z = z.data();
        a.intensity_of_point = last.data();
        a.offset = 0.03f;
        a.depth_gate_m = 0.3f;
        a.depth_scale_m = 0.05f;
        a.intensity_scale = 0.04f;
    }

    static Eigen::Isometry3d Pose() {
        return Se3Exp((Vector6d() << 0.02, -0.03, 0.01, 0.01, 0.02, -0.03).finished());
    }
};

std::vector<SumAligned> AlignPaths() {
    std::vector<SumAligned> paths = {baseline::SumAlignedPoints};
    if (CpuHasAvx2()) paths.push_back(avx2::SumAlignedPoints);
    return paths;
}

// Reference in double precision, with central-difference Jacobians and plain branches.
class SlowSums {
  public:
    explicit SlowSums(const TwoImages& images) : images_(images) {}

    PoseSums Sum() {
        for (std::size_t i = 0; i < TwoImages::kPoints; ++i) AddPoint(i);
        return sums_;
    }

  private:
    using Vector7d = Eigen::Matrix<double, 7, 1>;

    // Interpolates bilinearly between the four pixels of the cell at (u0, v0), and extrapolates
    // beyond it.
    struct Cell {
        int u0, v0;
        std::array<double, 4> pixel;

        double At(double u, double v) const {
            const double fu = u - u0, fv = v - v0;
            return (1 - fv) * ((1 - fu) * pixel[0] + fu * pixel[1]) +
                   fv * ((1 - fu) * pixel[2] + fu * pixel[3]);
        }
    };
    std::optional<Cell> CellOf(const std::vector<float>& image, double u, double v,
                               double least) const {
        if (u < 0 || v < 0 || u > TwoImages::kWidth - 1 || v > TwoImages::kHeight - 1)
            return std::nullopt;
        Cell cell{static_cast<int>(u), static_cast<int>(v), {}};
        for (int k = 0; k < 4; ++k) {
            const int at = (cell.v0 + k / 2) * TwoImages::kWidth + cell.u0 + k % 2;
            cell.pixel[static_cast<std::size_t>(k)] = image[static_cast<std::size_t>(at)];
        }
        if (*std::min_element(cell.pixel.begin(), cell.pixel.end()) < least) return std::nullopt;
        return cell;
    }

    double U(const Eigen::Vector3d& p) const { return images_.a.fx * p.x() / p.z() + images_.a.cx; }
    double V(const Eigen::Vector3d& p) const { return images_.a.fy * p.y() / p.z() + images_.a.cy; }

    void AddPoint(std::size_t i) {
        const AlignArguments& a = images_.a;
        if (images_.z[i] <= 0) return;
        const Eigen::Vector3d p =
            TwoImages::Pose() * Eigen::Vector3d(images_.x[i], images_.y[i], images_.z[i]);
        const double last = images_.last[i];
        const auto colour = CellOf(images_.intensity, U(p), V(p), 0.0),
                   depth = CellOf(images_.depth, U(p), V(p), 0.05);
        if (colour && last >= 0)
            Add(
                p,
                [&](const Eigen::Vector3d& q, double offset) {
                    return colour->At(U(q), V(q)) - (last + a.offset + offset);
                },
                a.intensity_scale);
        if (!depth || std::abs(depth->At(U(p), V(p)) - p.z()) > a.depth_gate_m) return;
        Add(
            p, [&](const Eigen::Vector3d& q, double) { return depth->At(U(q), V(q)) - q.z(); },
            a.depth_scale_m * std::max(1.0, static_cast<double>(images_.z[i])));
    }

    template <class Residual>
    void Add(const Eigen::Vector3d& p, const Residual& residual, double scale) {
        constexpr double kStep = 1e-6;
        Vector7d j;
        for (int k = 0; k < 6; ++k) {
            Vector6d twist = Vector6d::Zero();
            twist(k) = kStep;
            j(k) = (residual(Se3Exp(twist) * p, 0) - residual(Se3Exp(-twist) * p, 0)) / (2 * kStep);
        }
        j(6) = (residual(p, kStep) - residual(p, -kStep)) / (2 * kStep);
        const double r = residual(p, 0), w = std::min(1.0, scale / std::abs(r)) / (scale * scale);
        int at = L::kHessian;
        for (int row = 0; row < 6; ++row) {
            for (int column = row; column < 6; ++column, ++at)
                sums_.value[at] += w * j(row) * j(column);
            sums_.value[L::kGradient + row] += w * j(row) * r;
            sums_.value[L::kCoupling + 2 * row + 1] += w * j(row) * j(6);
        }
        sums_.value[L::kBrightness + 2] += w * j(6) * j(6);
        sums_.value[L::kBrightnessGradient + 1] += w * j(6) * r;
        sums_.value[L::kDistanceError] += std::min(r * r / (scale * scale), 4.0);
        sums_.value[L::kKnown] += 1;
    }

    const TwoImages& images_;
    PoseSums sums_;
};

TEST(AlignRows, AreTheSlowSumsWithDerivativesByCentralDifferences) {
    const TwoImages images;
    const PoseSums slow = SlowSums(images).Sum();
    ASSERT_GT(slow[L::kKnown], 1000);
    ASSERT_LT(slow[L::kKnown], 1800);
    double largest = 0;
    for (int k = 0; k < L::kGradient; ++k) largest = std::max(largest, std::abs(slow[k]));
    for (const SumAligned sum : AlignPaths()) {
        PoseSums sums;
        sum(images.a, 0, TwoImages::kPoints, sums.value);
        EXPECT_EQ(sums[L::kKnown], slow[L::kKnown]);
        EXPECT_NEAR(sums[L::kDistanceError], slow[L::kDistanceError], 1e-3);
        for (int k = 0; k < L::kCount; ++k)
            EXPECT_NEAR(sums[k], slow[k], 1e-5 * largest) << "sum " << k;
    }
}

// Every SIMD lane gives the same bytes as the kernel applied to one point at a time.
TEST(AlignRows, AreTheKernelsOneByOne) {
    const TwoImages images;
    PoseSums one_by_one;
    testing_support::SumOneByOne<AlignKernels<ScalarLanes>>(images.a, 0, TwoImages::kPoints,
                                                            one_by_one.value);
    for (const SumAligned sum : AlignPaths()) {
        PoseSums sums;
        sum(images.a, 0, TwoImages::kPoints, sums.value);
        EXPECT_EQ(std::memcmp(sums.value, one_by_one.value, sizeof sums.value), 0);
    }
}

}  // namespace
}  // namespace tessera
