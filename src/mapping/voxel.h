// The bit layout of a voxel, and the indexing of blocks and voxels. Host-device: plain functions on
// plain types, shared by the CPU code and CUDA.
//
// A block holds 8 x 8 x 8 voxels. Voxel (i, j, k), indexed over the whole world, has its centre at
// (i, j, k) * voxel_size_m. In a block, x runs fastest: offset = x + 8 y + 64 z. Indices round
// down.
#pragma once

#include <cstdint>

#include "core/host_device.h"
#include "core/scalar_ops.h"

namespace tessera {

inline constexpr int kBlockSide = 8;
inline constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;

// Geometry and intensity in one 32-bit word. The tracker reads both at eight corners, so each
// corner is one gather. Low half: intensity, 0 = none yet, else 1 + round(65534 * intensity). High
// half: signed distance in ranges (BlockMap::Config::range_m), two's complement, -32768 = none yet,
// else round(32767 * distance / range).
using FieldWord = std::uint32_t;
inline constexpr FieldWord kUnknownField = 0x80000000u;
inline constexpr float kDistanceSteps = 32767.0f;
inline constexpr float kIntensitySteps = 65534.0f;

// Signed distance in ranges, [-1, 1]; positive in front of the surface. Requires HasDistance.
TESSERA_HD float FieldDistance(FieldWord w) {
    return static_cast<float>(static_cast<std::int32_t>(w) >> 16) * (1.0f / kDistanceSteps);
}
TESSERA_HD bool HasDistance(FieldWord w) { return (w >> 16) != 0x8000u; }
// Intensity in [0, 1]. Requires HasIntensity.
TESSERA_HD float FieldIntensity(FieldWord w) {
    return static_cast<float>(static_cast<std::int32_t>(w & 0xffffu) - 1) *
           (1.0f / kIntensitySteps);
}
TESSERA_HD bool HasIntensity(FieldWord w) { return (w & 0xffffu) != 0; }

// Weight of the distance: 8.8 fixed point, up to 255.
inline constexpr float kWeightSteps = 256.0f;

// Chroma and colour weight. The field word's intensity is the luma, so nothing is stored twice.
// Bits 0-9 Cb, 10-19 Cr (each 512 + 1022 * chroma), 20-31 the colour weight in 1/16, up to 255. Cb
// = (B - Y) / 1.772, Cr = (R - Y) / 1.402.
using ColourWord = std::uint32_t;
inline constexpr float kChromaSteps = 1022.0f;  // chroma runs over [-0.5, 0.5]
inline constexpr float kColourWeightSteps = 16.0f;
inline constexpr ColourWord kNoColour = 512u | (512u << 10);
inline constexpr float kMaxWeight = 255.0f;  // of both weights

TESSERA_HD float ColourWeight(ColourWord c) {
    return static_cast<float>(c >> 20) * (1.0f / kColourWeightSteps);
}

// RGB in [0, 1], clamped, from an intensity in [0, 1] and chroma in the units of a colour word. A
// template on the number type, shared by scalar and SIMD code.
template <class F>
TESSERA_HD void RgbFromParts(const F& intensity, const F& cb_steps, const F& cr_steps, F* rgb) {
    const F cb = (cb_steps - F(512.0f)) * F(1.0f / kChromaSteps);
    const F cr = (cr_steps - F(512.0f)) * F(1.0f / kChromaSteps);
    rgb[0] = intensity + F(1.402f) * cr;
    rgb[2] = intensity + F(1.772f) * cb;
    rgb[1] = (intensity - F(0.299f) * rgb[0] - F(0.114f) * rgb[2]) * F(1.0f / 0.587f);
    for (int c = 0; c < 3; ++c) rgb[c] = min(max(rgb[c], F(0.0f)), F(1.0f));
}

struct LinearRgb {
    float r, g, b;
};
TESSERA_HD LinearRgb ColourFromWords(FieldWord field, ColourWord colour) {
    float rgb[3];
    RgbFromParts(FieldIntensity(field), static_cast<float>(colour & 1023u),
                 static_cast<float>((colour >> 10) & 1023u), rgb);
    return {rgb[0], rgb[1], rgb[2]};
}

// Integer coordinate of a block; block (0, 0, 0) holds voxels 0..7 along each axis.
struct BlockCoord {
    std::int32_t x = 0, y = 0, z = 0;
    TESSERA_HD_MEMBER bool operator==(const BlockCoord& o) const {
        return x == o.x && y == o.y && z == o.z;
    }
};
// By z, then y, then x. All sorted blocks use this order.
TESSERA_HD bool operator<(const BlockCoord& a, const BlockCoord& b) {
    return a.z != b.z ? a.z < b.z : (a.y != b.y ? a.y < b.y : a.x < b.x);
}

// Block coordinates lie in [-kBlockLimit, kBlockLimit) along each axis: 21 bits, so that a
// coordinate packs into 64.
inline constexpr std::int32_t kBlockLimit = 1 << 20;
TESSERA_HD bool InLimits(const BlockCoord& c) {
    return c.x >= -kBlockLimit && c.x < kBlockLimit && c.y >= -kBlockLimit && c.y < kBlockLimit &&
           c.z >= -kBlockLimit && c.z < kBlockLimit;
}

// Regions have this many blocks per side. A view looks up its blocks through them.
inline constexpr int kRegionShift = 2, kRegionBlocks = 1 << kRegionShift;
// The region that contains a block.
TESSERA_HD BlockCoord RegionOf(const BlockCoord& block) {
    // An arithmetic shift rounds down.
    return {block.x >> kRegionShift, block.y >> kRegionShift, block.z >> kRegionShift};
}

// Regions from `first` to `last` along each axis, inclusive.
struct RegionBox {
    std::int32_t first[3], last[3];

    TESSERA_HD_MEMBER bool Has(const BlockCoord& region) const {
        const std::int32_t at[3] = {region.x, region.y, region.z};
        bool inside = true;
        for (int k = 0; k < 3; ++k) inside &= at[k] >= first[k] && at[k] <= last[k];
        return inside;
    }
    TESSERA_HD_MEMBER std::int64_t Count() const {
        std::int64_t count = 1;
        for (int k = 0; k < 3; ++k) count *= std::int64_t{last[k]} - first[k] + 1;
        return count;
    }
};

// Position in the hash table before masking. Unsigned arithmetic wraps. A template on the number
// type, shared by scalar and SIMD code.
template <class U>
TESSERA_HD U HashBits(const U& x, const U& y, const U& z) {
    U h = (x * U(73856093u)) ^ (y * U(19349669u)) ^ (z * U(83492791u));
    h = h ^ (h >> 15);
    return ((h * U(2654435769u)) >> 4) ^ h;
}
TESSERA_HD std::uint32_t BlockHash(std::int32_t x, std::int32_t y, std::int32_t z) {
    return HashBits(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                    static_cast<std::uint32_t>(z));
}
TESSERA_HD std::uint32_t BlockHash(const BlockCoord& c) { return BlockHash(c.x, c.y, c.z); }

}  // namespace tessera
