#include "tracking/icp_simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "core/cpu.h"
#include "core/se3.h"
#include "tracking/icp_kernels.h"
#include "tracking/one_by_one.h"
#include "tracking/pose_solver.h"
#include "tracking/set_view.h"
#include "tracking/slow_icp_sums.h"

namespace tessera {
namespace {

using L = SumLayout;
using testing_support::Scene;
using testing_support::SlowIcpSums;

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

}  // namespace
}  // namespace tessera
