#include "tracking/sdf_simd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/cpu.h"
#include "mapping/block_map.h"
#include "support/box_room.h"
#include "tracking/one_by_one.h"
#include "tracking/pose_solver.h"
#include "tracking/sdf_kernels.h"

namespace tessera {
namespace {

using L = SumLayout;

// Fills every voxel of a cube of blocks with a smooth field. One block is missing and one voxel is
// unknown.
void Fill(BlockMap& map) {
    for (int z = -2; z <= 2; ++z)
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x) {
                if (x == 1 && y == 1 && z == 1) continue;
                const BlockId id = map.Allocate({x, y, z});
                for (int i = 0; i < kBlockVoxels; ++i) {
                    const double px = 8 * x + (i & 7), py = 8 * y + (i >> 3 & 7),
                                 pz = 8 * z + (i >> 6);
                    const double d = 0.8 * std::sin(0.07 * px + 0.05 * py - 0.06 * pz);
                    const double c = 0.5 + 0.4 * std::cos(0.11 * px - 0.08 * py + 0.05 * pz);
                    const auto distance = static_cast<std::int32_t>(std::lround(32767 * d));
                    const auto intensity = static_cast<std::uint32_t>(1 + std::lround(65534 * c));
                    map.field(id)[i] = static_cast<std::uint32_t>(distance) << 16 | intensity;
                    const double cb = 0.3 * std::sin(0.09 * px + 0.04 * pz),
                                 cr = 0.2 * std::cos(0.06 * py - 0.1 * pz);
                    map.colour(id)[i] =
                        static_cast<std::uint32_t>(std::lround(512 + 1022 * cb)) |
                        static_cast<std::uint32_t>(std::lround(512 + 1022 * cr)) << 10 | 16u << 20;
                }
            }
    map.field(map.Find({0, 0, 0}))[100] = kUnknownField;
    map.field(map.Find({-1, 0, 0}))[200] &= 0xffff0000u;  // distance without intensity
}

struct Points {
    std::vector<float> x, y, z, intensity, weight, cb, cr;

    explicit Points(int count) {
        std::uint32_t state = 12345;
        const auto random = [&state] {
            state = state * 1664525u + 1013904223u;
            return static_cast<float>(state >> 8) / static_cast<float>(1 << 24);
        };
        for (int i = 0; i < count; ++i) {
            x.push_back(0.3f * (random() - 0.5f));
            y.push_back(0.3f * (random() - 0.5f));
            z.push_back(0.3f * (random() - 0.5f));
            intensity.push_back(i % 7 == 0 ? -1.0f : random());
            weight.push_back(i % 5 == 0 ? 0.0f : 0.5f + random());
        }
        for (int i = 0; i < count; ++i) {
            cb.push_back(0.6f * (random() - 0.5f));
            cr.push_back(0.6f * (random() - 0.5f));
        }
    }
};

// R, G and B as the shares of luma and chroma in them, unclamped.
Eigen::Vector3d RgbOf(double y, double cb, double cr) {
    const double r = y + 1.402 * cr, b = y + 1.772 * cb;
    return {r, (y - 0.299 * r - 0.114 * b) / 0.587, b};
}

// Reference for the sums: one point at a time, one hash look-up per corner, in double precision.
// The photometric error is that of [B14] eq. 6 and 7: of R, G and B, weighted. Without chroma, luma
// stands for all three.
PoseSums SlowSdfSums(const BlockMap& map, const Points& points, const SdfArguments& a) {
    const double share[3] = {0.299, 0.587, 0.114};
    PoseSums sums;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        if (points.weight[i] <= 0) continue;
        const double p_camera[3] = {points.x[i], points.y[i], points.z[i]};
        double q[3], p[3];
        for (int k = 0; k < 3; ++k) {
            q[k] = a.translation[k];
            for (int m = 0; m < 3; ++m) q[k] += a.rotation[3 * k + m] * p_camera[m];
            p[k] = q[k] * a.voxel_size_m;
        }
        const int cell[3] = {int(std::floor(q[0])), int(std::floor(q[1])), int(std::floor(q[2]))};
        double distance[8], rgb[3][8];
        bool known = true, coloured = points.intensity[i] >= 0;
        for (int c = 0; c < 8; ++c) {
            const int x = 8 * a.origin_block[0] + cell[0] + (c & 1),
                      y = 8 * a.origin_block[1] + cell[1] + (c >> 1 & 1),
                      z = 8 * a.origin_block[2] + cell[2] + (c >> 2);
            const BlockId id = map.Find({x >> 3, y >> 3, z >> 3});
            const int at = (x & 7) + 8 * (y & 7) + 64 * (z & 7);
            const FieldWord w = map.field(id)[at];
            known = known && HasDistance(w);
            coloured = coloured && HasIntensity(w);
            distance[c] = FieldDistance(w);
            const ColourWord colour = a.colour != nullptr ? map.colour(id)[at] : kNoColour;
            const Eigen::Vector3d corner =
                RgbOf(FieldIntensity(w), ((colour & 1023) - 512.0) / 1022,
                      ((colour >> 10 & 1023) - 512.0) / 1022);
            for (int k = 0; k < 3; ++k) rgb[k][c] = corner(k);
        }
        if (!known) continue;
        const double weight = points.weight[i];
        // A residual at this point and its Jacobian.
        struct Term {
            double r, j[6];
        };
        const auto term = [&](const double* corner, double unit, double measured) {
            const auto s =
                Trilinear<double>(corner, q[0] - cell[0], q[1] - cell[1], q[2] - cell[2]);
            const double slope = unit / a.voxel_size_m;
            const double g[3] = {s.gx * slope, s.gy * slope, s.gz * slope};
            Term t{s.value * unit - measured, {}};
            PointJacobian(p, g, t.j);
            return t;
        };
        const Term d = term(distance, a.band.most_m, 0);
        const double wd = weight * std::min(1.0, a.distance_scale_m / std::abs(d.r));
        AddPoseTerm(d.j, d.r, wd, sums.value + L::kDistance);
        sums.value[L::kDistanceError] += wd * d.r * d.r;
        sums.value[L::kDistanceWeight] += wd;
        sums.value[L::kKnown] += 1;
        const double band = a.band.At(points.z[i]);
        sums.value[L::kBand] += wd * band * band;
        sums.value[L::kInliers] += std::abs(d.r) < 0.5 * band;
        if (!a.use_intensity || !coloured) continue;
        const bool chroma = a.colour != nullptr;
        const Eigen::Vector3d image =
            RgbOf(points.intensity[i], chroma ? points.cb[i] : 0, chroma ? points.cr[i] : 0);
        Term channel[3];
        double error2 = 0;
        for (int k = 0; k < 3; ++k) {
            channel[k] = term(rgb[k], 1.0, a.gain * image(k) + a.offset);
            error2 += share[k] * channel[k].r * channel[k].r;
        }
        const double w = weight * std::min(1.0, a.intensity_scale / std::sqrt(error2));
        for (int k = 0; k < 3; ++k) {
            AddPoseTerm(channel[k].j, channel[k].r, share[k] * w, sums.value + L::kIntensity);
            AddBrightnessTerm(channel[k].j, channel[k].r, image(k), share[k] * w, sums.value);
        }
        sums.value[L::kIntensityError] += w * error2;
        sums.value[L::kIntensityWeight] += w;
        sums.value[L::kColoured] += 1;
    }
    return sums;
}

enum class Colour { kNone, kIntensity, kChroma };

class SdfRows : public testing::TestWithParam<Colour> {};

TEST_P(SdfRows, AgreeWithTheSlowSums) {
    BlockMap map({.voxel_size_m = 0.01, .truncation_m = 0.04});
    Fill(map);
    const Points points(4096);
    SdfArguments a{};
    static_cast<BlockMapView&>(a) = map.view();
    Vector6d twist;
    twist << 0.3, -0.2, 0.5, 0, 0, 0;
    const Eigen::Matrix3d R = Se3Exp(twist).linear() / 0.01;
    for (int i = 0; i < 9; ++i) a.rotation[i] = static_cast<float>(R(i / 3, i % 3));
    a.translation[0] = 8.5f;
    a.translation[1] = -3.25f;
    a.translation[2] = 1.0f;
    a.origin_block[0] = -1;
    a.x = points.x.data();
    a.y = points.y.data();
    a.z = points.z.data();
    a.intensity = points.intensity.data();
    a.weight = points.weight.data();
    a.use_intensity = GetParam() != Colour::kNone;
    if (GetParam() == Colour::kChroma) {
        a.cb = points.cb.data();
        a.cr = points.cr.data();
        a.colour = map.colours();
    }
    a.gain = 1.1f;
    a.offset = -0.03f;
    a.distance_scale_m = 0.015f;
    a.intensity_scale = 0.1f;
    std::vector<float> distance_residual(4096), intensity_residual(4096);
    a.distance_residual = distance_residual.data();
    a.intensity_residual = intensity_residual.data();
    std::vector<float> gradient[3];
    for (int k = 0; k < 3; ++k) {
        gradient[k].resize(4096);
        a.gradient[k] = gradient[k].data();
    }

    const PoseSums slow = SlowSdfSums(map, points, a);
    ASSERT_GT(slow[L::kKnown], 1000);
    const auto expect_equal = [&](const PoseSums& sums) {
        for (int k = 0; k < L::kCount; ++k)
            EXPECT_NEAR(sums[k], slow[k], 2e-4 * (1.0 + std::abs(slow[k]))) << "sum " << k;
        EXPECT_EQ(sums[L::kKnown], slow[L::kKnown]);
        EXPECT_EQ(sums[L::kColoured], slow[L::kColoured]);
        const auto known = std::count_if(distance_residual.begin(), distance_residual.end(),
                                         [](float r) { return !std::isnan(r); });
        EXPECT_EQ(static_cast<double>(known), slow[L::kKnown]);
    };
    PoseSums portable;
    baseline::SumSdfPoints(a, 0, 4096, portable.value);
    expect_equal(portable);
    const std::vector<float> portable_distance = distance_residual,
                             portable_intensity = intensity_residual;
    const auto expect_the_same_bytes = [&](const PoseSums& sums) {
        EXPECT_EQ(std::memcmp(sums.value, portable.value, sizeof portable.value), 0);
        EXPECT_EQ(
            std::memcmp(portable_distance.data(), distance_residual.data(), 4096 * sizeof(float)),
            0);
        if (a.use_intensity) {
            EXPECT_EQ(std::memcmp(portable_intensity.data(), intensity_residual.data(),
                                  4096 * sizeof(float)),
                      0);
        }
    };
    PoseSums one_by_one;
    testing_support::SumOneByOne<SdfKernels<ScalarLanes>>(a, 0, 4096, one_by_one.value);
    expect_the_same_bytes(one_by_one);
    if (!CpuHasAvx2()) GTEST_SKIP() << "this machine has no AVX2: tested only the portable path";
    PoseSums vector;
    avx2::SumSdfPoints(a, 0, 4096, vector.value);
    expect_the_same_bytes(vector);
}

INSTANTIATE_TEST_SUITE_P(Colours, SdfRows,
                         testing::Values(Colour::kNone, Colour::kIntensity, Colour::kChroma));

}  // namespace
}  // namespace tessera
