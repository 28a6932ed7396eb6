// Vectors of floats and integers for the hot loops, as wide as the file that includes this is compiled for. Included
// only by vector sources (tessera_vector_source in cmake/TesseraTargets.cmake), which include no Eigen. The shared
// kernel templates take float or Real alike.
#pragma once

#include <cstdint>
#include <xsimd/xsimd.hpp>

namespace tessera::TESSERA_VECTOR_NAMESPACE {

using Real = xsimd::batch<float>;
using Int = xsimd::batch<std::int32_t>;
using Bits = xsimd::batch<std::uint32_t>;  // wraps; >> is logical
using RealMask = xsimd::batch_bool<float>;
inline constexpr int kLanes = static_cast<int>(Real::size);

[[gnu::always_inline]] inline Real Load(const float* p) { return Real::load_unaligned(p); }
[[gnu::always_inline]] inline Int Load(const std::int32_t* p) { return Int::load_unaligned(p); }
// base[index] per lane. (xsimd 8.1 takes its portable path even where AVX2 has an instruction.)
[[gnu::always_inline]] inline Real Gather(const float* base, const Int& index) {
#ifdef __AVX2__
    return _mm256_i32gather_ps(base, index, 4);
#else
    return Real::gather(base, index);
#endif
}
[[gnu::always_inline]] inline Int Gather(const std::int32_t* base, const Int& index) {
#ifdef __AVX2__
    return _mm256_i32gather_epi32(base, index, 4);
#else
    return Int::gather(base, index);
#endif
}
[[gnu::always_inline]] inline RealMask AsRealMask(const xsimd::batch_bool<std::int32_t>& m) {
    return xsimd::bool_cast(m);
}
[[gnu::always_inline]] inline xsimd::batch_bool<std::int32_t> AsIntMask(const RealMask& m) {
    return xsimd::bool_cast(m);
}
[[gnu::always_inline]] inline Real Select(const RealMask& m, const Real& a, const Real& b) {
    return xsimd::select(m, a, b);
}
[[gnu::always_inline]] inline Int Select(const RealMask& m, const Int& a, const Int& b) {
    return xsimd::select(AsIntMask(m), a, b);
}
[[gnu::always_inline]] inline Int AsInt(const Bits& b) { return xsimd::bitwise_cast<Int>(b); }
[[gnu::always_inline]] inline Bits AsBits(const Int& i) { return xsimd::bitwise_cast<Bits>(i); }
// 0, 1, 2, ...
[[gnu::always_inline]] inline Real LaneNumbers() {
    alignas(64) float numbers[kLanes];
    for (int i = 0; i < kLanes; ++i) numbers[i] = static_cast<float>(i);
    return Real::load_aligned(numbers);
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
