// Lanes: the template parameter of the kernels (*_kernels.h). One kernel source serves the SIMD
// paths (vector_lanes.h), scalar code and CUDA. A kernel with lanes V processes V::kCount voxels,
// points or pixels at once and takes its types and operations from V. It combines masks with && and
// ||, which do not short-circuit for SIMD vectors. This file defines scalar lanes, one element at a
// time. GPU threads use them, and tests use them as the reference.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "core/host_device.h"

namespace tessera {

struct ScalarLanes {
    using Real = float;
    using Int = std::int32_t;
    using Bits = std::uint32_t;  // wraps; >> is logical
    using Mask = bool;
    static constexpr int kCount = 1;

    // kCount consecutive elements in memory, aligned or not. 16-bit values are zero-extended on
    // load and truncated on store.
    TESSERA_HD_MEMBER static Real Load(const float* p) { return *p; }
    TESSERA_HD_MEMBER static Bits Load(const std::uint32_t* p) { return *p; }
    TESSERA_HD_MEMBER static Int Load(const std::uint16_t* p) { return *p; }
    TESSERA_HD_MEMBER static void Store(Real v, float* p) { *p = v; }
    TESSERA_HD_MEMBER static void Store(Bits v, std::uint32_t* p) { *p = v; }
    TESSERA_HD_MEMBER static void Store(Int v, std::uint16_t* p) {
        *p = static_cast<std::uint16_t>(v);
    }
    // base[index] per lane.
    TESSERA_HD_MEMBER static Real Gather(const float* base, Int index) { return base[index]; }
    TESSERA_HD_MEMBER static Int Gather(const std::int32_t* base, Int index) { return base[index]; }
    TESSERA_HD_MEMBER static Bits Gather(const std::uint32_t* base, Int index) {
        return base[index];
    }

    TESSERA_HD_MEMBER static Real ToReal(Int v) { return static_cast<float>(v); }
    // Truncates towards zero. Values that do not fit, including NaN, become the lowest integer, as
    // on x86.
    TESSERA_HD_MEMBER static Int ToInt(Real v) {
        return Abs(v) < 2147483648.0f ? static_cast<Int>(v) : std::numeric_limits<Int>::min();
    }
    TESSERA_HD_MEMBER static Int AsInt(Bits v) { return static_cast<Int>(v); }
    TESSERA_HD_MEMBER static Bits AsBits(Int v) { return static_cast<Bits>(v); }

    // Converts the result of an integer comparison to a mask.
    TESSERA_HD_MEMBER static Mask ToMask(bool m) { return m; }
    TESSERA_HD_MEMBER static Mask Not(Mask m) { return !m; }
    TESSERA_HD_MEMBER static bool Any(Mask m) { return m; }
    TESSERA_HD_MEMBER static Real Select(Mask m, Real a, Real b) { return m ? a : b; }
    TESSERA_HD_MEMBER static Int Select(Mask m, Int a, Int b) { return m ? a : b; }

    // Both return b if either argument is NaN.
    TESSERA_HD_MEMBER static Real Min(Real a, Real b) { return a < b ? a : b; }
    TESSERA_HD_MEMBER static Real Max(Real a, Real b) { return a > b ? a : b; }
    TESSERA_HD_MEMBER static Int Min(Int a, Int b) { return a < b ? a : b; }
    TESSERA_HD_MEMBER static Int Max(Int a, Int b) { return a > b ? a : b; }
    TESSERA_HD_MEMBER static Real Abs(Real v) { return std::fabs(v); }
    TESSERA_HD_MEMBER static Real Floor(Real v) { return std::floor(v); }
    TESSERA_HD_MEMBER static Real Sqrt(Real v) { return std::sqrt(v); }

    // Sum of all lanes, as a tree: adds the upper half to the lower half until one lane is left.
    TESSERA_HD_MEMBER static float Sum(Real v) { return v; }

    // Lane indices: 0, 1, 2, ...
    TESSERA_HD_MEMBER static Real Numbers() { return 0.0f; }
};

}  // namespace tessera
