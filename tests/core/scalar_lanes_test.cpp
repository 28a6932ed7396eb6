// Tests each scalar lane operation at its edge cases, and compares it with its SIMD counterpart on
// numbers of all magnitudes.
#include "core/scalar_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/cpu.h"
#include "core/lane_operations.h"

namespace tessera {
namespace {

using namespace testing_support;
using S = ScalarLanes;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();
constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();

TEST(ScalarLanes, Edges) {
    EXPECT_EQ(S::Floor(-0.25f), -1.0f);
    EXPECT_EQ(S::Floor(-3.0f), -3.0f);
    EXPECT_EQ(S::Floor(-1e9f), -1e9f);
    EXPECT_EQ(S::ToInt(-1.75f), -1);
    EXPECT_EQ(S::ToInt(2147483520.0f), 2147483520);  // the largest float that fits
    for (const float v :
         {2147483648.0f, -2147483648.0f, 1e20f, -1e20f, kInfinity, -kInfinity, kNan})
        EXPECT_EQ(S::ToInt(v), kLeast) << v;
    EXPECT_EQ(S::Min(kNan, 2.0f), 2.0f);
    EXPECT_EQ(S::Max(kNan, 2.0f), 2.0f);
    EXPECT_TRUE(std::isnan(S::Min(2.0f, kNan)));
    EXPECT_TRUE(std::isnan(S::Max(2.0f, kNan)));
    EXPECT_EQ(S::Load(std::array<std::uint16_t, 1>{65535}.data()), 65535);
    EXPECT_EQ(S::AsInt(0x80000000u) >> 16, -32768);
}

// Small and large numbers of both signs, integers, values next to integers, and non-finite values.
std::unique_ptr<LaneInputs> Inputs() {
    auto in = std::make_unique<LaneInputs>();
    std::uint32_t state = 20240607;
    const auto random = [&state] {
        state = state * 1664525u + 1013904223u;
        return state ^ state >> 16;
    };
    const auto real = [&] {
        const float digits = static_cast<float>(random() % 4096u) - 2048.0f;
        const float v = std::ldexp(digits, static_cast<int>(random() % 40u) - 20);
        return random() % 4 == 0 ? std::floor(v) : v;
    };
    for (int k = 0; k < kLaneInputs; ++k) {
        in->a[k] = real();
        in->b[k] = random() % 8 == 0 ? in->a[k] : real();
        in->i[k] = random();
        in->j[k] = random() % 8 == 0 ? in->i[k] : random();
        in->narrow[k] = static_cast<std::uint16_t>(random());
        in->index[k] = random() % kLaneInputs;
    }
    const float special[] = {kNan,           kInfinity,  -kInfinity,  2147483648.0f,
                             -2147483648.0f, 3e9f,       -3e9f,       2147483520.0f,
                             -0.0f,          0.0f,       -0.5f,       -1.0f,
                             1e-40f,         8388607.5f, -8388607.5f, 16777217.0f};
    int k = 0;
    for (const float a : special)
        for (const float b : special) {
            in->a[k] = a;
            in->b[k++] = b;
        }
    return in;
}

class LaneTwins : public ::testing::TestWithParam<bool> {};

TEST_P(LaneTwins, MakeTheSameOfTheSameNumbers) {
    auto* apply = baseline::ApplyLanes;
    if (GetParam()) {
        if (!CpuHasAvx2()) GTEST_SKIP() << "this machine has no AVX2";
#ifdef TESSERA_HAVE_AVX2
        apply = avx2::ApplyLanes;
#endif
    }
    const auto in = Inputs();
    const auto scalar = std::make_unique<LaneResults>(), vector = std::make_unique<LaneResults>();
    ApplyLaneOperations<ScalarLanes>(*in, *scalar);
    const int lanes = apply(*in, *vector);
    ASSERT_GT(lanes, 1);
    const auto same = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    for (int k = 0; k < kLaneInputs; ++k) {
        for (const RealOperation op : {kMin, kMax, kAbs, kFloor, kSqrt, kToReal, kSelect, kGather})
            EXPECT_PRED2(same, scalar->real[op][k], vector->real[op][k])
                << "operation " << op << " of " << in->a[k];
        EXPECT_EQ(vector->real[kNumbers][k], static_cast<float>(k % lanes));
        for (int op = 0; op < kAny; ++op)
            EXPECT_EQ(scalar->bits[op][k], vector->bits[op][k])
                << "operation " << op << " of " << in->a[k];
        const int first = k - k % lanes;
        const bool any = std::any_of(scalar->bits[kAny] + first, scalar->bits[kAny] + first + lanes,
                                     [](std::uint32_t m) { return m != 0; });
        EXPECT_EQ(vector->bits[kAny][k], any);
        EXPECT_EQ(scalar->narrow[k], vector->narrow[k]);
    }
}

INSTANTIATE_TEST_SUITE_P(Widths, LaneTwins, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Avx2" : "Baseline"; });

}  // namespace
}  // namespace tessera
