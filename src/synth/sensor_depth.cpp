// Depth part of the sensor model.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "synth/hash_random.h"
#include "synth/sensor_model.h"

namespace tessera {
namespace {

constexpr std::uint64_t kDisparityStream = 1, kEdgeStream = 2;
// Neighbouring pixels whose depths differ by a larger share are separated by a discontinuity.
constexpr float kEdgeShare = 0.03f;

// Cubic B-spline weights at fraction t, scaled so that their squares sum to 1.
void UnitSplineWeights(double t, float weights[4]) {
    const double s = 1 - t;
    const double w[4] = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                         (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
    const double norm = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3]);
    for (int i = 0; i < 4; ++i) weights[i] = static_cast<float>(w[i] / norm);
}

bool IsEdge(float z, float neighbour) { return !(std::abs(neighbour - z) <= kEdgeShare * z); }

bool HasEdgeBeside(const DepthImage& depth, int x, int y) {
    const float z = depth(x, y);
    constexpr int kSteps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (const auto& [dx, dy] : kSteps)
        if (depth.Contains(x + dx, y + dy) && IsEdge(z, depth(x + dx, y + dy))) return true;
    return false;
}

}  // namespace

SmoothNoise::SmoothNoise(std::uint64_t key, double sigma_px, int width)
    : key_(key), spacing_px_(sigma_px * std::sqrt(3.0)), width_(width) {}

void SmoothNoise::Row(int y, std::vector<float>& out) const {
    float weights[4];
    const double v = y / spacing_px_;
    const int row = static_cast<int>(v);
    UnitSplineWeights(v - row, weights);
    const int columns = static_cast<int>(width_ / spacing_px_) + 5;
    std::vector<float> sums(static_cast<std::size_t>(columns));
    for (int c = 0; c < columns; ++c)
        for (int i = 0; i < 4; ++i)
            sums[c] +=
                weights[i] *
                GaussianFromBits(MixBits(key_ + (static_cast<std::uint64_t>(row + i) << 20) + c));
    out.resize(static_cast<std::size_t>(width_));
    for (int x = 0; x < width_; ++x) {
        const double u = x / spacing_px_;
        const int column = static_cast<int>(u);
        UnitSplineWeights(u - column, weights);
        out[x] = weights[0] * sums[column] + weights[1] * sums[column + 1] +
                 weights[2] * sums[column + 2] + weights[3] * sums[column + 3];
    }
}

void SensorModel::SenseDepthRow(const RenderedView& view, std::int64_t frame, int y,
                                float* out) const {
    const DepthImage& truth = view.depth_m;
    const int width = truth.width();
    const auto frame_key = static_cast<std::uint64_t>(frame);
    std::vector<float> noise;
    SmoothNoise(StreamKey(seed_, kDisparityStream, frame_key), config_.correlation_px, width)
        .Row(y, noise);
    const std::uint64_t edge_key = StreamKey(seed_, kEdgeStream, frame_key);
    const double focal_baseline = config_.focal_px * config_.baseline_m;
    const double step = config_.disparity_step_px;
    // Rightmost projector column that is occluded by a nearer surface to the left.
    double lit_until = -1e9;
    for (int x = 0; x < width; ++x) {
        out[x] = 0;
        if (!(truth(x, y) > 0)) continue;
        // In the projector's view a surface is shifted to the right, the nearer the more.
        const double projector_x = x + camera_.fx * config_.baseline_m / truth(x, y);
        const bool in_shadow = config_.shadow && projector_x < lit_until - 1.0;
        lit_until = std::max(lit_until, projector_x);
        if (in_shadow) continue;

        const std::uint64_t counter = 4 * (static_cast<std::uint64_t>(y) * width + x);
        const auto jitter = [&](std::uint64_t i) {
            const float shift = GaussianFromBits(MixBits(edge_key + counter + i));
            return static_cast<int>(std::lround(config_.lateral_std_px * shift));
        };
        const int from_x = std::clamp(x + jitter(0), 0, width - 1);
        const int from_y = std::clamp(y + jitter(1), 0, truth.height() - 1);
        // The jitter moves discontinuities only; smooth surfaces stay in place.
        const bool moved = IsEdge(truth(x, y), truth(from_x, from_y));
        const float z = moved ? truth(from_x, from_y) : truth(x, y);
        const float cosine = moved ? view.cos_incidence(from_x, from_y) : view.cos_incidence(x, y);
        if (!(z > 0) || cosine < config_.min_cos) continue;
        if (HasEdgeBeside(truth, x, y) &&
            UniformFromBits(MixBits(edge_key + counter + 2)) < config_.edge_dropout)
            continue;

        double disparity = focal_baseline / z + config_.disparity_std_px * noise[x];
        if (step > 0) disparity = std::round(disparity / step) * step;
        if (disparity <= 0) continue;
        const double measured = focal_baseline / disparity;
        if (measured >= config_.min_depth_m && measured <= config_.max_depth_m)
            out[x] = static_cast<float>(measured);
    }
}

void SensorModel::SenseDepth(const RenderedView& view, std::int64_t frame,
                             DepthImage& depth_m) const {
    if (config_.noise == NoiseModel::kNone) {
        depth_m = view.depth_m;
        return;
    }
    depth_m.Resize(view.depth_m.width(), view.depth_m.height());
    tbb::parallel_for(0, depth_m.height(),
                      [&](int y) { SenseDepthRow(view, frame, y, depth_m.row(y)); });
}

}  // namespace tessera
