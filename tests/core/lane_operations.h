// Applies every operation of core/scalar_lanes.h to arrays of numbers. lane_operations.cpp compiles
// it with SIMD lanes, and the test compiles it with scalar lanes. The SIMD code and the test share
// only these plain arrays.
#pragma once

#include <cstdint>

#include "core/host_device.h"

namespace tessera::testing_support {

inline constexpr int kLaneInputs = 1024;  // a multiple of every SIMD width

struct LaneInputs {
    float a[kLaneInputs], b[kLaneInputs];
    std::uint32_t i[kLaneInputs], j[kLaneInputs];
    std::uint16_t narrow[kLaneInputs];
    std::uint32_t index[kLaneInputs];  // into the arrays above
};

enum RealOperation {
    kMin,
    kMax,
    kAbs,
    kFloor,
    kSqrt,
    kToReal,
    kSelect,
    kGather,
    kNumbers,
    kRealOperations
};
enum BitsOperation {
    kToInt,
    kIntMin,
    kIntMax,
    kIntSelect,
    kIntShift,
    kBitsShift,
    kIntGather,
    kBitsGather,
    kWiden,
    kNot,
    kAndOr,
    kIntMask,
    kAny,
    kBitsOperations
};

struct LaneResults {
    float real[kRealOperations][kLaneInputs];
    std::uint32_t bits[kBitsOperations][kLaneInputs];
    std::uint16_t narrow[kLaneInputs];
};

template <class V>
TESSERA_HD void ApplyLaneOperations(const LaneInputs& in, LaneResults& out) {
    using Real = typename V::Real;
    using Int = typename V::Int;
    using Bits = typename V::Bits;
    using Mask = typename V::Mask;
    for (int at = 0; at < kLaneInputs; at += V::kCount) {
        const Real a = V::Load(in.a + at), b = V::Load(in.b + at);
        const Bits unsigned_i = V::Load(in.i + at), unsigned_j = V::Load(in.j + at);
        const Int i = V::AsInt(unsigned_i), j = V::AsInt(unsigned_j),
                  index = V::AsInt(V::Load(in.index + at));
        const Mask less = a < b;
        const auto real = [&](RealOperation operation, const Real& v) {
            V::Store(v, out.real[operation] + at);
        };
        const auto bits = [&](BitsOperation operation, const Bits& v) {
            V::Store(v, out.bits[operation] + at);
        };
        const auto mask = [&](BitsOperation operation, const Mask& m) {
            bits(operation, V::AsBits(V::Select(m, Int(1), Int(0))));
        };
        real(kMin, V::Min(a, b));
        real(kMax, V::Max(a, b));
        real(kAbs, V::Abs(a));
        real(kFloor, V::Floor(a));
        real(kSqrt, V::Sqrt(a));
        real(kToReal, V::ToReal(i));
        real(kSelect, V::Select(less, a, b));
        real(kGather, V::Gather(in.a, index));
        real(kNumbers, V::Numbers());
        bits(kToInt, V::AsBits(V::ToInt(a)));
        bits(kIntMin, V::AsBits(V::Min(i, j)));
        bits(kIntMax, V::AsBits(V::Max(i, j)));
        bits(kIntSelect, V::AsBits(V::Select(less, i, j)));
        bits(kIntShift, V::AsBits((i >> 16) + (j << 3)));
        bits(kBitsShift, (unsigned_i >> 16) * unsigned_j);
        bits(kIntGather, V::AsBits(V::Gather(reinterpret_cast<const std::int32_t*>(in.i), index)));
        bits(kBitsGather, V::Gather(in.j, index));
        bits(kWiden, V::AsBits(V::Load(in.narrow + at)));
        mask(kNot, V::Not(less));
        mask(kAndOr, (less && (a > Real(0.0f))) || (b == b));
        mask(kIntMask, V::ToMask(i == j) || V::ToMask(i > j));
        bits(kAny, Bits(V::Any(less) ? 1u : 0u));
        V::Store(i, out.narrow + at);
    }
}

// Returns the number of lanes.
namespace baseline {
int ApplyLanes(const LaneInputs& in, LaneResults& out);
}  // namespace baseline
namespace avx2 {
int ApplyLanes(const LaneInputs& in, LaneResults& out);
}  // namespace avx2

}  // namespace tessera::testing_support
