// SIMD lanes for the hot loops on the CPU: vectors of floats and integers, as wide as the compile
// flags of the including file allow. Only SIMD sources (tessera_vector_source in
// cmake/TesseraTargets.cmake) include this, and they include no Eigen. scalar_lanes.h documents
// each operation.
#pragma once

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "core/host_device.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {

struct VectorLanes {
    using Real = xsimd::batch<float>;
    using Int = xsimd::batch<std::int32_t>;
    using Bits = xsimd::batch<std::uint32_t>;
    using Mask = xsimd::batch_bool<float>;
    static constexpr int kCount = static_cast<int>(Real::size);

    TESSERA_HD_MEMBER static Real Load(const float* p) { return Real::load_unaligned(p); }
    TESSERA_HD_MEMBER static Bits Load(const std::uint32_t* p) { return Bits::load_unaligned(p); }
    TESSERA_HD_MEMBER static Int Load(const std::uint16_t* p) {
        alignas(64) std::int32_t values[kCount];
        for (int i = 0; i < kCount; ++i) values[i] = p[i];
        return Int::load_aligned(values);
    }
    TESSERA_HD_MEMBER static void Store(const Real& v, float* p) { v.store_unaligned(p); }
    TESSERA_HD_MEMBER static void Store(const Bits& v, std::uint32_t* p) { v.store_unaligned(p); }
    TESSERA_HD_MEMBER static void Store(const Int& v, std::uint16_t* p) {
        alignas(64) std::int32_t values[kCount];
        v.store_aligned(values);
        for (int i = 0; i < kCount; ++i) p[i] = static_cast<std::uint16_t>(values[i]);
    }
    // xsimd 8.1 uses its portable gather even where AVX2 has an instruction for it.
    TESSERA_HD_MEMBER static Real Gather(const float* base, const Int& index) {
#ifdef __AVX2__
        return _mm256_i32gather_ps(base, index, 4);
#else
        return Real::gather(base, index);
#endif
    }
    TESSERA_HD_MEMBER static Int Gather(const std::int32_t* base, const Int& index) {
#ifdef __AVX2__
        return _mm256_i32gather_epi32(base, index, 4);
#else
        return Int::gather(base, index);
#endif
    }
    TESSERA_HD_MEMBER static Bits Gather(const std::uint32_t* base, const Int& index) {
        return AsBits(Gather(reinterpret_cast<const std::int32_t*>(base), index));
    }

    TESSERA_HD_MEMBER static Real ToReal(const Int& v) { return xsimd::to_float(v); }
    TESSERA_HD_MEMBER static Int ToInt(const Real& v) { return xsimd::to_int(v); }
    TESSERA_HD_MEMBER static Int AsInt(const Bits& v) { return xsimd::bitwise_cast<Int>(v); }
    TESSERA_HD_MEMBER static Bits AsBits(const Int& v) { return xsimd::bitwise_cast<Bits>(v); }

    TESSERA_HD_MEMBER static Mask ToMask(const xsimd::batch_bool<std::int32_t>& m) {
        return xsimd::bool_cast(m);
    }
    TESSERA_HD_MEMBER static Mask Not(const Mask& m) { return ~m; }
    TESSERA_HD_MEMBER static bool Any(const Mask& m) { return xsimd::any(m); }
    TESSERA_HD_MEMBER static Real Select(const Mask& m, const Real& a, const Real& b) {
        return xsimd::select(m, a, b);
    }
    TESSERA_HD_MEMBER static Int Select(const Mask& m, const Int& a, const Int& b) {
        return xsimd::select(xsimd::batch_bool<std::int32_t>(xsimd::bool_cast(m)), a, b);
    }

    TESSERA_HD_MEMBER static Real Min(const Real& a, const Real& b) { return xsimd::min(a, b); }
    TESSERA_HD_MEMBER static Real Max(const Real& a, const Real& b) { return xsimd::max(a, b); }
    TESSERA_HD_MEMBER static Int Min(const Int& a, const Int& b) { return xsimd::min(a, b); }
    TESSERA_HD_MEMBER static Int Max(const Int& a, const Int& b) { return xsimd::max(a, b); }
    TESSERA_HD_MEMBER static Real Abs(const Real& v) { return xsimd::abs(v); }
    TESSERA_HD_MEMBER static Real Floor(const Real& v) { return xsimd::floor(v); }
    TESSERA_HD_MEMBER static Real Sqrt(const Real& v) { return xsimd::sqrt(v); }

    TESSERA_HD_MEMBER static float Sum(const Real& v) {
#ifdef __AVX2__
        const __m128 four = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
        const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
        return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
#else
        alignas(64) float lanes[kCount];
        v.store_aligned(lanes);
        for (int half = kCount / 2; half > 0; half /= 2)
            for (int i = 0; i < half; ++i) lanes[i] += lanes[i + half];
        return lanes[0];
#endif
    }

    TESSERA_HD_MEMBER static Real Numbers() {
        alignas(64) float numbers[kCount];
        for (int i = 0; i < kCount; ++i) numbers[i] = static_cast<float>(i);
        return Real::load_aligned(numbers);
    }
};

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
