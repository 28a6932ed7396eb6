#include "mapping/fusion_rows.h"

#include "core/vector_types.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {
namespace {

constexpr int kStepsPerRow = kBlockSide / kLanes;
static_assert(kBlockSide % kLanes == 0);

[[gnu::always_inline]] inline Bits LoadBits(const std::uint32_t* p) { return Bits::load_unaligned(p); }

struct Point {
    Real x, y, z;
};

// A row of voxels in a camera: an affine function of the voxel's x.
struct Row {
    float origin[3], step[3];

    [[gnu::always_inline]] Row(const VoxelToCamera& t, float voxel, float vx, float vy, float vz) {
        for (int i = 0; i < 3; ++i) {
            const float* r = t.rotation + 3 * i;
            origin[i] = (r[0] * vx + r[1] * vy + r[2] * vz) * voxel + t.translation[i];
            step[i] = r[0] * voxel;
        }
    }
    [[gnu::always_inline]] Point At(const Real& x) const {
        return {Real(origin[0]) + x * Real(step[0]), Real(origin[1]) + x * Real(step[1]),
                Real(origin[2]) + x * Real(step[2])};
    }
};

// Where a point of the camera at the frame's instant is for the camera at time t: to first order
// p - t (omega x p + velocity).
[[gnu::always_inline]] inline Point AtTime(const FusionArguments& a, const Point& p, const Real& t) {
    const float* w = a.twist_per_s;
    return {p.x - t * (Real(w[1]) * p.z - Real(w[2]) * p.y + Real(w[3])),
            p.y - t * (Real(w[2]) * p.x - Real(w[0]) * p.z + Real(w[4])),
            p.z - t * (Real(w[0]) * p.y - Real(w[1]) * p.x + Real(w[5]))};
}

// Time of the row that a point is seen in, in read-outs from the middle row.
[[gnu::always_inline]] inline Real RowTime(const FusionArguments& a, const Point& p) {
    const Real v = p.y / xsimd::max(p.z, Real(0.05f)) * Real(a.fy) + Real(a.cy);
    const Real share = v * Real(1.0f / static_cast<float>(a.height)) - Real(0.5f);
    return xsimd::min(xsimd::max(share, Real(-0.5f)), Real(0.5f));
}

// Index of the nearest pixel and whether the point is in front of the camera and in the image. [B14] eq. 2.
[[gnu::always_inline]] inline Int NearestPixel(const FusionArguments& a, const Point& p, RealMask& inside) {
    const Real inverse_z = Real(1.0f) / p.z;
    const Real u = p.x * inverse_z * Real(a.fx) + Real(a.cx + 0.5f);
    const Real v = p.y * inverse_z * Real(a.fy) + Real(a.cy + 0.5f);
    inside = (p.z > Real(0.05f)) & (u >= Real(0.0f)) & (v >= Real(0.0f)) &
             (u < Real(static_cast<float>(a.width))) & (v < Real(static_cast<float>(a.height)));
    const Int column = xsimd::to_int(Select(inside, u, Real(0.0f)));
    const Int line = xsimd::to_int(Select(inside, v, Real(0.0f)));
    return line * Int(a.width) + column;
}

[[gnu::always_inline]] inline Real WeightOf(const FusionArguments& a, const Real& distance, const Real& depth) {
    switch (a.distance_weight) {
        case DistanceWeight::kDepthNoise: return Real(a.frame_weight) / (depth * depth);
        case DistanceWeight::kLinearExp:
            return Real(a.frame_weight) * LinearExpWeight(distance, a.epsilon_m, a.sigma,
                                                          [](const Real& v) { return xsimd::exp(v); });
        case DistanceWeight::kConstant: break;
    }
    return Real(a.frame_weight);
}

// floor(value + dither), dither uniform in [0, 1) from 16 bits.
[[gnu::always_inline]] inline Int DitheredRound(const Real& value, const Bits& bits16) {
    const Real dither = xsimd::to_float(AsInt(bits16)) * Real(1.0f / 65536.0f);
    return xsimd::to_int(xsimd::floor(value + dither));
}

struct Voxels {
    Bits field;
    Real weight;
    Bits colour;
};

[[gnu::always_inline]] inline void FuseDistance(const FusionArguments& a, const RealMask& update,
                                                const Real& distance, const Real& weight, const Bits& dither,
                                                Voxels& v) {
    const Real truncated = xsimd::min(distance, Real(a.truncation_m));
    const Real steps = truncated * Real(kDistanceSteps / a.truncation_m);
    const Real old_steps = xsimd::to_float(AsInt(v.field) >> 16);
    const Real average = WeightedAverage(old_steps, v.weight, steps, weight);
    Int rounded = DitheredRound(average, dither & Bits(0xffffu));
    rounded = xsimd::min(xsimd::max(rounded, Int(-32767)), Int(32767));
    const Int field = (rounded << 16) | (AsInt(v.field) & Int(0xffff));
    v.field = AsBits(Select(update, field, AsInt(v.field)));
    v.weight = Select(update, xsimd::min(v.weight + weight, Real(a.max_weight)), v.weight);
}

// Intensity and chroma, [B14] eq. 18-20 and [D18] eq. 6 in luma and chroma instead of R, G, B: the same average.
[[gnu::always_inline]] inline void FuseColour(const FusionArguments& a, const RealMask& update,
                                              const Bits& pixel, const Real& weight, const Bits& address,
                                              const Bits& dither, Voxels& v) {
    const Int old_colour = AsInt(v.colour);
    const Real old_weight = xsimd::to_float(AsInt(v.colour >> 20)) * Real(1.0f / kColourWeightSteps);
    const Real old_share = old_weight / (old_weight + weight);
    const Real new_share = Real(1.0f) - old_share;
    const auto average = [&](const Int& old_steps, const Real& value) {
        return old_share * xsimd::to_float(old_steps) + new_share * value;
    };
    const Real y = xsimd::to_float(AsInt(pixel & Bits(0xffffu))) * Real(a.gain * kIntensitySteps / 65535.0f) +
                   Real(1.0f + a.offset * kIntensitySteps);
    const Real chroma_scale(a.gain * kChromaSteps / kPackedChroma);
    const Real cb = (xsimd::to_float(AsInt((pixel >> 16) & Bits(255u))) - Real(128.0f)) * chroma_scale + Real(512.0f);
    const Real cr = (xsimd::to_float(AsInt(pixel >> 24)) - Real(128.0f)) * chroma_scale + Real(512.0f);
    const Bits more = DitherBits(address, ~a.frame);
    Int new_y = DitheredRound(average(AsInt(v.field & Bits(0xffffu)), y), dither >> 16);
    Int new_cb = DitheredRound(average(old_colour & Int(1023), cb), more & Bits(0xffffu));
    Int new_cr = DitheredRound(average((old_colour >> 10) & Int(1023), cr), more >> 16);
    new_y = xsimd::min(xsimd::max(new_y, Int(1)), Int(65535));
    new_cb = xsimd::min(xsimd::max(new_cb, Int(0)), Int(1023));
    new_cr = xsimd::min(xsimd::max(new_cr, Int(0)), Int(1023));
    const Real summed = xsimd::min(old_weight + weight, Real(a.max_colour_weight));
    const Int steps = xsimd::to_int(summed * Real(kColourWeightSteps) + Real(0.5f));
    const Int packed = new_cb | (new_cr << 10) | (steps << 20);
    v.field = AsBits(Select(update, (AsInt(v.field) & Int(~0xffff)) | new_y, AsInt(v.field)));
    v.colour = AsBits(Select(update, packed, old_colour));
}

[[gnu::always_inline]] inline void StoreWeights(std::uint16_t* p, const Real& weight) {
    alignas(64) std::int32_t steps[kLanes];
    xsimd::to_int(weight * Real(kWeightSteps) + Real(0.5f)).store_aligned(steps);
    for (int i = 0; i < kLanes; ++i) p[i] = static_cast<std::uint16_t>(steps[i]);
}

[[gnu::always_inline]] inline Real LoadWeights(const std::uint16_t* p) {
    alignas(64) std::int32_t steps[kLanes];
    for (int i = 0; i < kLanes; ++i) steps[i] = p[i];
    return xsimd::to_float(Int::load_aligned(steps)) * Real(1.0f / kWeightSteps);
}

[[gnu::always_inline]] inline void FuseVoxels(const FusionArguments& a, const Point& instant, std::size_t at,
                                              std::uint32_t seed) {
    RealMask inside;
    Point p = instant;
    Real row_time(0.0f);
    if (a.moving) {
        row_time = RowTime(a, instant);
        p = AtTime(a, instant, row_time * Real(a.depth_readout_s));
    }
    const Int pixel = NearestPixel(a, p, inside);
    const Real depth = Gather(a.depth_m, pixel);
    const Real distance = depth - p.z;  // -([B14] eq. 12)
    const RealMask update = inside & (depth > Real(0.0f)) & (distance >= Real(-a.truncation_m));
    if (!xsimd::any(update)) return;

    Voxels v{LoadBits(a.field + at), LoadWeights(a.weight + at), LoadBits(a.colour + at)};
    // Weights below the stored resolution would be lost.
    const Real weight = xsimd::max(WeightOf(a, distance, xsimd::max(depth, Real(0.05f))), Real(1.0f / kWeightSteps));
    const Bits address = Bits(seed) + AsBits(xsimd::to_int(LaneNumbers()));
    const Bits dither = DitherBits(address, a.frame);
    FuseDistance(a, update, distance, weight, dither, v);
    v.field.store_unaligned(a.field + at);
    StoreWeights(a.weight + at, v.weight);

    RealMask coloured = update & (distance <= Real(a.truncation_m));
    if (a.packed_colour == nullptr || !xsimd::any(coloured)) return;
    const Point q =
        a.moving ? AtTime(a, instant, Real(a.colour_delay_s) + row_time * Real(a.colour_readout_s)) : instant;
    RealMask in_colour;
    const Int colour_pixel = NearestPixel(a, q, in_colour);
    coloured = coloured & in_colour;
    const Bits packed = AsBits(Gather(reinterpret_cast<const std::int32_t*>(a.packed_colour), colour_pixel));
    Real colour_weight = weight * Real(a.frame_colour_weight / a.frame_weight);
    if (a.colour_weighting == ColourWeighting::kCosine)
        colour_weight = colour_weight * p.z / xsimd::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    colour_weight = xsimd::max(colour_weight, Real(1.0f / kColourWeightSteps));
    FuseColour(a, coloured, packed, colour_weight, address, dither, v);
    v.field.store_unaligned(a.field + at);
    v.colour.store_unaligned(a.colour + at);
}

}  // namespace

void FuseBlocks(const FusionArguments& a, const std::int32_t* blocks, std::int32_t count) {
    const Real lanes = LaneNumbers();
    for (std::int32_t b = 0; b < count; ++b) {
        const std::int32_t* c = a.coords + 4 * static_cast<std::size_t>(blocks[b]);
        const float vx = static_cast<float>(c[0] * kBlockSide - a.origin[0]);
        std::size_t at = static_cast<std::size_t>(blocks[b]) * kBlockVoxels;
        std::uint32_t seed = static_cast<std::uint32_t>(c[3]) * kBlockVoxels;
        for (int z = 0; z < kBlockSide; ++z) {
            const float vz = static_cast<float>(c[2] * kBlockSide + z - a.origin[2]);
            for (int y = 0; y < kBlockSide; ++y) {
                const float vy = static_cast<float>(c[1] * kBlockSide + y - a.origin[1]);
                const Row row(a.to_camera, a.voxel_size_m, vx, vy, vz);
                for (int step = 0; step < kStepsPerRow; ++step, at += kLanes, seed += kLanes) {
                    const Real x = lanes + Real(static_cast<float>(step * kLanes));
                    FuseVoxels(a, row.At(x), at, seed);
                }
            }
        }
    }
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
