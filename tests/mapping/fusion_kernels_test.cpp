#include "mapping/fusion_kernels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera {
namespace {

// [B14] eq. 13. Its d is the negative of our signed distance, and its delta is the map's truncation
// distance.
TEST(FusionKernels, LinearExpWeightIsEquation13) {
    constexpr float kEpsilon = 0.025f, kSigma = 60.0f;
    EXPECT_FLOAT_EQ(LinearExpWeight(0.1f, kEpsilon, kSigma), 1.0f);     // in front of the surface
    EXPECT_FLOAT_EQ(LinearExpWeight(-0.025f, kEpsilon, kSigma), 1.0f);  // d = epsilon
    // d - epsilon = 0.1.
    EXPECT_NEAR(LinearExpWeight(-0.125f, kEpsilon, kSigma), std::exp(-60.0 * 0.01), 1e-6);
    EXPECT_NEAR(LinearExpWeight(-0.3f, kEpsilon, kSigma), std::exp(-60.0 * 0.275 * 0.275), 1e-6);
}

TEST(FusionKernels, ExpOfNegativeIsTheExponential) {
    EXPECT_EQ(ExpOfNegative(0.0f), 1.0f);
    for (float v = 0; v > -10; v -= 0.01f)
        EXPECT_NEAR(ExpOfNegative(v), std::exp(static_cast<double>(v)), 1e-6) << v;
    for (float v = -10; v > -200; v -= 1) {
        EXPECT_NEAR(ExpOfNegative(v), std::exp(static_cast<double>(v)), 3e-9) << v;
        EXPECT_GE(ExpOfNegative(v), 0) << v;
    }
}

// [B14] eq. 14: (3 * 0.02 + 1 * 0.06) / 4 = 0.03.
TEST(FusionKernels, WeightedAverageIsEquation14) {
    EXPECT_NEAR(WeightedAverage(0.02f, 3.0f, 0.06f, 1.0f), 0.03f, 1e-7);
    EXPECT_NEAR(WeightedAverage(0.0f, 0.0f, 0.06f, 0.25f), 0.06f, 1e-7);
}

TEST(FusionKernels, DitherIsEvenlySpread) {
    double mean = 0, high = 0;
    constexpr int kCount = 1 << 16;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const std::uint32_t bits = DitherBits(i, 7u);
        mean += (bits & 0xffffu) / 65536.0;
        high += (bits >> 16) / 65536.0;
    }
    EXPECT_NEAR(mean / kCount, 0.5, 0.01);
    EXPECT_NEAR(high / kCount, 0.5, 0.01);
    EXPECT_NE(DitherBits(5u, 1u), DitherBits(5u, 2u));
}

}  // namespace
}  // namespace tessera
