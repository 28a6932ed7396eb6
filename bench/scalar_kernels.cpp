#include "scalar_kernels.h"

#include <algorithm>
#include <cmath>

#include "mapping/field_sampler.h"
#include "mapping/fusion_kernels.h"

namespace tessera::bench {
namespace {

using L = SumLayout;

struct Point {
    float p[3];  // in the local frame, in metres
    float depth, weight, image;
};

void AddDistance(const SdfArguments& a, const Point& point, const ValueAndGradient<float>& s,
                 float* sums) {
    float steepness = 1.0f;
    if (a.normalise)
        steepness = 1.0f / std::max(1.0f, std::sqrt(s.gx * s.gx + s.gy * s.gy + s.gz * s.gz));
    const float residual = s.value * steepness;
    const float g[3] = {s.gx * steepness, s.gy * steepness, s.gz * steepness};
    const float w = point.weight * HuberWeight(residual, a.distance_scale_m);
    float j[6];
    PointJacobian(point.p, g, j);
    AddPoseTerm(j, residual, w, sums + L::kDistance);
    sums[L::kDistanceError] += w * residual * residual;
    sums[L::kDistanceWeight] += w;
    sums[L::kKnown] += 1.0f;
    const float band = a.band.At(point.depth);
    sums[L::kBand] += w * band * band;
    sums[L::kInliers] += std::abs(residual) < 0.5f * band ? 1.0f : 0.0f;
}

void AddIntensity(const SdfArguments& a, const Point& point, const ValueAndGradient<float>& s,
                  float* sums) {
    const float residual = s.value - (a.gain * point.image + a.offset);
    const float g[3] = {s.gx, s.gy, s.gz};
    const float w = point.weight * HuberWeight(residual, a.intensity_scale);
    float j[6];
    PointJacobian(point.p, g, j);
    AddPoseTerm(j, residual, w, sums + L::kIntensity);
    AddBrightnessTerm(j, residual, point.image, w, sums);
    sums[L::kIntensityError] += w * residual * residual;
    sums[L::kIntensityWeight] += w;
    sums[L::kColoured] += 1.0f;
}

template <bool kIntensity>
void SumPoints(const SdfArguments& a, int first, int last, float* sums) {
    FieldSampler<SdfArguments> sampler(a,
                                       {a.origin_block[0], a.origin_block[1], a.origin_block[2]});
    for (int i = first; i < last; ++i) {
        if (a.weight[i] <= 0.0f) continue;
        float q[3];
        Point point{{}, a.z[i], a.weight[i], a.intensity[i]};
        for (int k = 0; k < 3; ++k) {
            const float* r = a.rotation + 3 * k;
            q[k] = r[0] * a.x[i] + r[1] * a.y[i] + r[2] * a.z[i] + a.translation[k];
            point.p[k] = q[k] * a.voxel_size_m;
        }
        const FieldSample s = sampler.Sample<kIntensity>(sampler.Locate(q[0], q[1], q[2]));
        if (!s.has_distance) continue;
        AddDistance(a, point, s.distance, sums);
        if (kIntensity && s.has_intensity && point.image >= 0.0f)
            AddIntensity(a, point, s.intensity, sums);
    }
}

// References to the layers of one voxel.
struct Voxel {
    FieldWord& field;
    std::uint16_t& weight;
    ColourWord& colour;
};

int DitheredRound(float value, std::uint32_t bits16, int low, int high) {
    return std::clamp(static_cast<int>(std::floor(value + static_cast<float>(bits16) / 65536.0f)),
                      low, high);
}

float WeightOf(const FusionArguments& a, float distance, float depth) {
    float weight = a.frame_weight;
    if (a.distance_weight == DistanceWeight::kDepthNoise) weight /= depth * depth;
    if (a.distance_weight == DistanceWeight::kLinearExp)
        weight *= LinearExpWeight(distance, a.epsilon_m, a.sigma);
    return std::max(weight, 1.0f / kWeightSteps);
}

void FuseDistance(const FusionArguments& a, float distance, float weight, std::uint32_t dither,
                  Voxel& v) {
    const float steps = distance * (kDistanceSteps / a.band.most_m);
    const float old_steps = static_cast<float>(static_cast<std::int32_t>(v.field) >> 16);
    const float old_weight = static_cast<float>(v.weight) / kWeightSteps;
    const float average = WeightedAverage(old_steps, old_weight, steps, weight);
    const int rounded = DitheredRound(average, dither & 0xffffu, -32767, 32767);
    v.field = static_cast<std::uint32_t>(rounded) << 16 | (v.field & 0xffffu);
    v.weight = static_cast<std::uint16_t>(
        std::min(old_weight + weight, a.max_weight) * kWeightSteps + 0.5f);
}

void FuseColour(const FusionArguments& a, std::uint32_t pixel, float weight, std::uint32_t address,
                std::uint32_t dither, Voxel& v) {
    const float old_weight = ColourWeight(v.colour);
    const auto average = [&](std::uint32_t old_steps, float value) {
        return WeightedAverage(static_cast<float>(old_steps), old_weight, value, weight);
    };
    const auto chroma = [&](std::uint32_t byte) {
        return (static_cast<float>(byte) - 128.0f) * (a.gain * kChromaSteps / kPackedChroma) +
               512.0f;
    };
    const float y = static_cast<float>(pixel & 0xffffu) * (a.gain * kIntensitySteps / 65535.0f) +
                    (1.0f + a.offset * kIntensitySteps);
    const std::uint32_t more = DitherBits(address, ~a.frame);
    const int new_y = DitheredRound(average(v.field & 0xffffu, y), dither >> 16, 1, 65535);
    const int cb = DitheredRound(average(v.colour & 1023u, chroma(pixel >> 16 & 255u)),
                                 more & 0xffffu, 0, 1023);
    const int cr =
        DitheredRound(average(v.colour >> 10 & 1023u, chroma(pixel >> 24)), more >> 16, 0, 1023);
    const auto steps = static_cast<std::uint32_t>(
        std::min(old_weight + weight, a.max_colour_weight) * kColourWeightSteps + 0.5f);
    v.field = (v.field & 0xffff0000u) | static_cast<std::uint32_t>(new_y);
    v.colour = static_cast<std::uint32_t>(cb) | static_cast<std::uint32_t>(cr) << 10 | steps << 20;
}

void FuseVoxel(const FusionArguments& a, const float* p, std::size_t at) {
    if (!(p[2] > 0.05f)) return;
    const float u = p[0] / p[2] * a.fx + (a.cx + 0.5f), v = p[1] / p[2] * a.fy + (a.cy + 0.5f);
    if (!(u >= 0.0f && v >= 0.0f && u < static_cast<float>(a.width) &&
          v < static_cast<float>(a.height)))
        return;
    const int pixel = static_cast<int>(v) * a.width + static_cast<int>(u);
    const float depth = a.depth_m[pixel], distance = depth - p[2];
    const float band = a.band.At(depth);
    if (!(depth > 0.0f && distance >= -band)) return;
    Voxel voxel{a.field[at], a.weight[at], a.colour[at]};
    const float weight = WeightOf(a, distance, std::max(depth, 0.05f));
    const auto address = static_cast<std::uint32_t>(at);
    const std::uint32_t dither = DitherBits(address, a.frame);
    FuseDistance(a, std::min(distance, band), weight, dither, voxel);
    if (a.packed_colour == nullptr || distance > band) return;
    float colour_weight = weight * a.frame_colour_weight / a.frame_weight;
    if (a.colour_weighting == ColourWeighting::kCosine)
        colour_weight *= p[2] / std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    FuseColour(a, a.packed_colour[pixel], std::max(colour_weight, 1.0f / kColourWeightSteps),
               address, dither, voxel);
}

}  // namespace

void SumSdfPointsScalar(const SdfArguments& a, int first, int last, double* sums) {
    // Short runs, so that the float sums keep their precision.
    constexpr int kRun = 1024;
    for (int i = first; i < last; i += kRun) {
        float run[L::kCount] = {};
        const int end = std::min(i + kRun, last);
        a.use_intensity ? SumPoints<true>(a, i, end, run) : SumPoints<false>(a, i, end, run);
        for (int k = 0; k < L::kCount; ++k) sums[k] += static_cast<double>(run[k]);
    }
}

void FuseBlocksScalar(const FusionArguments& a, const std::int32_t* blocks, std::int32_t count) {
    for (std::int32_t b = 0; b < count; ++b) {
        const std::int32_t* c = a.coords + 4 * static_cast<std::size_t>(blocks[b]);
        const std::size_t first = static_cast<std::size_t>(blocks[b]) * kBlockVoxels;
        for (int offset = 0; offset < kBlockVoxels; ++offset) {
            const int in_block[3] = {offset & 7, offset >> 3 & 7, offset >> 6};
            float voxel[3], p[3];
            for (int k = 0; k < 3; ++k)
                voxel[k] = static_cast<float>(c[k] * kBlockSide + in_block[k] - a.origin[k]) *
                           a.voxel_size_m;
            for (int k = 0; k < 3; ++k) {
                const float* r = a.to_camera.rotation + 3 * k;
                p[k] = r[0] * voxel[0] + r[1] * voxel[1] + r[2] * voxel[2] +
                       a.to_camera.translation[k];
            }
            FuseVoxel(a, p, first + static_cast<std::size_t>(offset));
        }
    }
}

}  // namespace tessera::bench
