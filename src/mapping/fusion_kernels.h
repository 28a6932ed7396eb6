// Fusion: updates lanes of voxels (scalar_lanes.h) from one frame, for the CPU's SIMD kernels and
// CUDA. Distances are in metres, positive in front of the surface; [B14] eq. 12 has the opposite
// sign.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/scalar_ops.h"
#include "mapping/fusion_arguments.h"
#include "mapping/fusion_formulas.h"

namespace tessera {

// Fraction of its weight that a voxel of a disappeared surface keeps per frame: full weight fades
// to almost nothing within half a second.
inline constexpr float kKeptOfGone = 0.6f;

// Fuses lanes V of neighbouring voxels.
template <class V>
class FusionKernels {
  public:
    using Real = typename V::Real;
    using Int = typename V::Int;
    using Bits = typename V::Bits;
    using Mask = typename V::Mask;

    // Eight voxels along x in the camera frame: an affine function of x.
    struct Row {
        float origin[3], step[3];
        std::size_t at;      // layer index of the first voxel
        std::uint32_t seed;  // dither seed of the first voxel
    };

    // Row (y, z) of a block.
    TESSERA_HD_MEMBER static Row RowOf(const FusionArguments& a, std::int32_t block, int y, int z) {
        const std::int32_t* c = a.coords + 4 * static_cast<std::size_t>(block);
        const float vx = static_cast<float>(c[0] * kBlockSide - a.origin[0]);
        const float vy = static_cast<float>(c[1] * kBlockSide + y - a.origin[1]);
        const float vz = static_cast<float>(c[2] * kBlockSide + z - a.origin[2]);
        Row row;
        for (int i = 0; i < 3; ++i) {
            const float* r = a.to_camera.rotation + 3 * i;
            row.origin[i] =
                (r[0] * vx + r[1] * vy + r[2] * vz) * a.voxel_size_m + a.to_camera.translation[i];
            row.step[i] = r[0] * a.voxel_size_m;
        }
        const int in_block = kBlockSide * (y + kBlockSide * z);
        row.at =
            static_cast<std::size_t>(block) * kBlockVoxels + static_cast<std::size_t>(in_block);
        row.seed =
            static_cast<std::uint32_t>(c[3]) * kBlockVoxels + static_cast<std::uint32_t>(in_block);
        return row;
    }

    // Updates the voxels [x, x + V::kCount) of a row. Voxels that the frame does not see keep their
    // values.
    TESSERA_HD_MEMBER static void FuseVoxels(const FusionArguments& a, const Row& row, int x) {
        const Point instant = PointAt(row, V::Numbers() + Real(static_cast<float>(x)));
        Mask inside;
        Point p = instant;
        Real row_time(0.0f);
        if (a.moving) {
            row_time = RowTime(a, instant);
            p = AtTime(a, instant, row_time * Real(a.depth_readout_s));
        }
        const Int pixel = NearestPixel(a, p, inside);
        const Real depth = V::Gather(a.depth_m, pixel);
        const Real distance = depth - p.z;  // -([B14] eq. 12)
        const Real band = a.band.At(depth);
        const Mask update = inside && (depth > Real(0.0f)) && (distance >= Real(0.0f) - band);
        if (!V::Any(update)) return;

        FieldWord* field = a.field + row.at + x;
        std::uint16_t* weight_steps = a.weight + row.at + x;
        ColourWord* colour = a.colour + row.at + x;
        Voxels v{V::Load(field), V::ToReal(V::Load(weight_steps)) * Real(1.0f / kWeightSteps),
                 V::Load(colour)};
        // Quickly forget a surface that is known to have disappeared.
        if (a.gone_m != nullptr) {
            const Real seen = V::Gather(a.gone_m, pixel);
            const Mask gone = update && (seen - p.z > a.band.At(seen));
            v.weight = V::Select(gone, v.weight * Real(kKeptOfGone), v.weight);
        }
        // Weights below the stored resolution would be lost.
        const Real weight =
            V::Max(WeightOf(a, distance, V::Max(depth, Real(0.05f))), Real(1.0f / kWeightSteps));
        const Bits address =
            Bits(row.seed + static_cast<std::uint32_t>(x)) + V::AsBits(V::ToInt(V::Numbers()));
        const Bits dither = DitherBits(address, a.frame);
        FuseDistance(a, update, V::Min(distance, band), weight, dither, v);
        V::Store(v.field, field);
        V::Store(V::ToInt(v.weight * Real(kWeightSteps) + Real(0.5f)), weight_steps);

        Mask coloured = update && (distance <= band);
        if (a.packed_colour == nullptr || !V::Any(coloured)) return;
        const Point q =
            a.moving
                ? AtTime(a, instant, Real(a.colour_delay_s) + row_time * Real(a.colour_readout_s))
                : instant;
        Mask in_colour;
        const Int colour_pixel = NearestPixel(a, q, in_colour);
        coloured = coloured && in_colour;
        const Bits packed = V::Gather(a.packed_colour, colour_pixel);
        FuseColour(a, coloured, packed, ColourWeightOf(a, weight, p), address, dither, v);
        V::Store(v.field, field);
        V::Store(v.colour, colour);
    }

  private:
    struct Point {
        Real x, y, z;
    };
    struct Voxels {
        Bits field;
        Real weight;
        Bits colour;
    };

    // Camera-frame positions of the voxels at x of a row.
    TESSERA_HD_MEMBER static Point PointAt(const Row& row, const Real& x) {
        return {Real(row.origin[0]) + x * Real(row.step[0]),
                Real(row.origin[1]) + x * Real(row.step[1]),
                Real(row.origin[2]) + x * Real(row.step[2])};
    }

    // Transforms a point from the camera frame at the frame's timestamp to the camera frame at time
    // t, to first order: p - t (omega x p + velocity).
    TESSERA_HD_MEMBER static Point AtTime(const FusionArguments& a, const Point& p, const Real& t) {
        const float* w = a.twist_per_s;
        return {p.x - t * (Real(w[1]) * p.z - Real(w[2]) * p.y + Real(w[3])),
                p.y - t * (Real(w[2]) * p.x - Real(w[0]) * p.z + Real(w[4])),
                p.z - t * (Real(w[0]) * p.y - Real(w[1]) * p.x + Real(w[5]))};
    }

    // Time of the row in which a point is seen, in read-out times relative to the middle row.
    TESSERA_HD_MEMBER static Real RowTime(const FusionArguments& a, const Point& p) {
        const Real v = p.y / V::Max(p.z, Real(0.05f)) * Real(a.fy) + Real(a.cy);
        const Real share = v * Real(1.0f / static_cast<float>(a.height)) - Real(0.5f);
        return V::Min(V::Max(share, Real(-0.5f)), Real(0.5f));
    }

    // Index of the nearest pixel. `inside`: the point is in front of the camera and in the image.
    // [B14] eq. 2.
    TESSERA_HD_MEMBER static Int NearestPixel(const FusionArguments& a, const Point& p,
                                              Mask& inside) {
        const Real inverse_z = Real(1.0f) / p.z;
        const Real u = p.x * inverse_z * Real(a.fx) + Real(a.cx + 0.5f);
        const Real v = p.y * inverse_z * Real(a.fy) + Real(a.cy + 0.5f);
        inside = (p.z > Real(0.05f)) && (u >= Real(0.0f)) && (v >= Real(0.0f)) &&
                 (u < Real(static_cast<float>(a.width))) &&
                 (v < Real(static_cast<float>(a.height)));
        const Int column = V::ToInt(V::Select(inside, u, Real(0.0f)));
        const Int line = V::ToInt(V::Select(inside, v, Real(0.0f)));
        return line * Int(a.width) + column;
    }

    TESSERA_HD_MEMBER static Real WeightOf(const FusionArguments& a, const Real& distance,
                                           const Real& depth) {
        switch (a.distance_weight) {
            case DistanceWeight::kDepthNoise: return Real(a.frame_weight) / (depth * depth);
            case DistanceWeight::kLinearExp:
                return Real(a.frame_weight) * LinearExpWeight(distance, a.epsilon_m, a.sigma);
            case DistanceWeight::kConstant: break;
        }
        return Real(a.frame_weight);
    }

    // Derives the colour weight from the distance weight, for voxels at p.
    TESSERA_HD_MEMBER static Real ColourWeightOf(const FusionArguments& a, Real weight,
                                                 const Point& p) {
        weight = weight * Real(a.frame_colour_weight / a.frame_weight);
        if (a.colour_weighting == ColourWeighting::kCosine)
            weight = weight * p.z / V::Sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
        return V::Max(weight, Real(1.0f / kColourWeightSteps));
    }

    // floor(value + dither), dither uniform in [0, 1) from 16 bits.
    TESSERA_HD_MEMBER static Int DitheredRound(const Real& value, const Bits& bits16) {
        const Real dither = V::ToReal(V::AsInt(bits16)) * Real(1.0f / 65536.0f);
        return V::ToInt(V::Floor(value + dither));
    }

    TESSERA_HD_MEMBER static void FuseDistance(const FusionArguments& a, const Mask& update,
                                               const Real& distance, const Real& weight,
                                               const Bits& dither, Voxels& v) {
        const Real steps = distance * Real(kDistanceSteps / a.band.most_m);
        const Real old_steps = V::ToReal(V::AsInt(v.field) >> 16);
        const Real average = WeightedAverage(old_steps, v.weight, steps, weight);
        Int rounded = DitheredRound(average, dither & Bits(0xffffu));
        rounded = V::Min(V::Max(rounded, Int(-32767)), Int(32767));
        const Int field = (rounded << 16) | (V::AsInt(v.field) & Int(0xffff));
        v.field = V::AsBits(V::Select(update, field, V::AsInt(v.field)));
        v.weight = V::Select(update, V::Min(v.weight + weight, Real(a.max_weight)), v.weight);
    }

    // Fuses intensity and chroma: [B14] eq. 18-20 and [D18] eq. 6, in luma and chroma instead of R,
    // G, B. The average is the same.
    TESSERA_HD_MEMBER static void FuseColour(const FusionArguments& a, const Mask& update,
                                             const Bits& pixel, const Real& weight,
                                             const Bits& address, const Bits& dither, Voxels& v) {
        const Int old_colour = V::AsInt(v.colour);
        const Real old_weight =
            V::ToReal(V::AsInt(v.colour >> 20)) * Real(1.0f / kColourWeightSteps);
        const Real old_share = old_weight / (old_weight + weight);
        const Real new_share = Real(1.0f) - old_share;
        const auto average = [&](const Int& old_steps, const Real& value) {
            return old_share * V::ToReal(old_steps) + new_share * value;
        };
        const Real y =
            V::ToReal(V::AsInt(pixel & Bits(0xffffu))) * Real(a.gain * kIntensitySteps / 65535.0f) +
            Real(1.0f + a.offset * kIntensitySteps);
        const Real chroma_scale(a.gain * kChromaSteps / kPackedChroma);
        const Real cb =
            (V::ToReal(V::AsInt((pixel >> 16) & Bits(255u))) - Real(128.0f)) * chroma_scale +
            Real(512.0f);
        const Real cr =
            (V::ToReal(V::AsInt(pixel >> 24)) - Real(128.0f)) * chroma_scale + Real(512.0f);
        const Bits more = DitherBits(address, ~a.frame);
        Int new_y = DitheredRound(average(V::AsInt(v.field & Bits(0xffffu)), y), dither >> 16);
        Int new_cb = DitheredRound(average(old_colour & Int(1023), cb), more & Bits(0xffffu));
        Int new_cr = DitheredRound(average((old_colour >> 10) & Int(1023), cr), more >> 16);
        new_y = V::Min(V::Max(new_y, Int(1)), Int(65535));
        new_cb = V::Min(V::Max(new_cb, Int(0)), Int(1023));
        new_cr = V::Min(V::Max(new_cr, Int(0)), Int(1023));
        const Real summed = V::Min(old_weight + weight, Real(a.max_colour_weight));
        const Int steps = V::ToInt(summed * Real(kColourWeightSteps) + Real(0.5f));
        const Int packed = new_cb | (new_cr << 10) | (steps << 20);
        v.field = V::AsBits(
            V::Select(update, (V::AsInt(v.field) & Int(~0xffff)) | new_y, V::AsInt(v.field)));
        v.colour = V::AsBits(V::Select(update, packed, old_colour));
    }
};

}  // namespace tessera
