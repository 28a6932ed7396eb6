#include "tracking/photometry.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// Variance of the means of kBlock x kBlock neighbouring samples, times the samples per block: the variance of a
// residual as it counts in a sum. For independent residuals it is their variance; errors that neighbours share
// (depth deformation, calibration, blur) make it larger. The method of batch means.
double BatchMeansVariance(const std::vector<float>& residuals, int width, int height) {
    constexpr int kBlock = 16, kLeast = kBlock * kBlock / 2;
    double sum = 0, sum2 = 0, samples = 0;
    std::int64_t blocks = 0;
    for (int by = 0; by + kBlock <= height; by += kBlock)
        for (int bx = 0; bx + kBlock <= width; bx += kBlock) {
            double total = 0;
            int known = 0;
            for (int y = by; y < by + kBlock; ++y)
                for (int x = bx; x < bx + kBlock; ++x) {
                    const float r = residuals[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                              static_cast<std::size_t>(x)];
                    if (std::isnan(r)) continue;
                    total += r;
                    ++known;
                }
            if (known < kLeast) continue;
            const double mean = total / known;
            sum += mean;
            sum2 += mean * mean;
            samples += known;
            ++blocks;
        }
    if (blocks < 16) return 0;
    const auto n = static_cast<double>(blocks);
    return (sum2 / n - (sum / n) * (sum / n)) * (samples / n);
}

// The same for a residual whose Jacobian changes from pixel to pixel: the variance of its score, residual times image
// gradient over depth (what a sideways move changes), summed over kBlock x kBlock neighbours, over the sum of the squared
// gradients. Errors at edges, where the gradient is large, count as they pull. What a whole tile is wrong by together
// (`shading_error`, intensities in [0, 1]) is added: it hardly pulls where texture has gradients of all signs, and a lot
// where the only gradient is shading, which residuals against a map of the same shading do not show.
double ScoreVariance(const std::vector<float>& residuals, const FramePoints& points, double shading_error) {
    constexpr int kBlock = 16, kLeast = kBlock * kBlock / 2;
    const int width = points.width(), height = points.height();
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    };
    double scores2 = 0, shading_scores2 = 0, information = 0;
    std::int64_t blocks = 0;
    for (int by = 1; by + kBlock < height; by += kBlock)
        for (int bx = 1; bx + kBlock < width; bx += kBlock) {
            double score_u = 0, score_v = 0, sum_u = 0, sum_v = 0, gradients2 = 0;
            int known = 0;
            for (int y = by; y < by + kBlock; ++y)
                for (int x = bx; x < bx + kBlock; ++x) {
                    const float r = residuals[at(x, y)], z = points.z[at(x, y)];
                    const float left = points.intensity[at(x - 1, y)], right = points.intensity[at(x + 1, y)];
                    const float up = points.intensity[at(x, y - 1)], down = points.intensity[at(x, y + 1)];
                    if (std::isnan(r) || z <= 0 || left < 0 || right < 0 || up < 0 || down < 0) continue;
                    const double gu = (right - left) / z, gv = (down - up) / z;
                    score_u += r * gu;
                    score_v += r * gv;
                    sum_u += gu;
                    sum_v += gv;
                    gradients2 += gu * gu + gv * gv;
                    ++known;
                }
            if (known < kLeast) continue;
            scores2 += score_u * score_u + score_v * score_v;
            shading_scores2 += sum_u * sum_u + sum_v * sum_v;
            information += gradients2;
            ++blocks;
        }
    if (blocks < 16 || information <= 0) return 0;
    return (scores2 + shading_error * shading_error * shading_scores2) / information;
}

}  // namespace

Photometry::Photometry(const Config& config, const PinholeCamera& camera)
    : config_(config), shutter_(config.shutter, camera) {
    Reset();
}

void Photometry::Reset() {
    alpha_ = config_.alpha;
    gain_ = 1;
    offset_ = 0;
    distance_variance_ = intensity_variance_ = 0;
    shutter_.Reset();
}

void Photometry::SetAlpha(bool automatic, double alpha) {
    config_.alpha_mode = automatic ? AlphaMode::kAuto : AlphaMode::kFixed;
    if (automatic) return;
    config_.alpha = alpha;
    alpha_ = alpha;
}

void Photometry::SaveState(StateWriter& state) const {
    for (const double value : {alpha_, gain_, offset_, distance_variance_, intensity_variance_}) state.Put(value);
    shutter_.SaveState(state);
}

bool Photometry::LoadState(StateReader& state) {
    for (double* value : {&alpha_, &gain_, &offset_, &distance_variance_, &intensity_variance_})
        if (!state.Get(*value) || !std::isfinite(*value)) return false;
    return shutter_.LoadState(state);
}

FrameMotion Photometry::Timed(FrameMotion motion) const {
    motion.colour_delay_s += shutter_.delay_s();
    motion.colour_readout_s += shutter_.readout_s();
    return motion;
}

void Photometry::Learn(const PreparedFrame& frame, const FramePoints& points,
                       const std::vector<float>& distance_residual, const std::vector<float>& intensity_residual,
                       const TrackResult& result) {
    gain_ = result.gain;
    offset_ = result.offset;
    if (result.alpha <= 0 || result.degenerate) return;  // where the pose is not held, it explains what it should not
    shutter_.Update(frame, points, intensity_residual, result.motion, result.gain, result.intensity_rms);
    if (config_.alpha_mode == AlphaMode::kAuto) UpdateAlpha(points, distance_residual, intensity_residual);
}

// Each residual's weight is the inverse of its variance as it counts in the sum, so alpha in [B14] eq. 8 is the ratio of
// the two. Plain variances would say that the geometry knows ten times more than it does.
void Photometry::UpdateAlpha(const FramePoints& points, const std::vector<float>& distance_residual,
                             const std::vector<float>& intensity_residual) {
    const double distance = BatchMeansVariance(distance_residual, points.width(), points.height());
    const double intensity = ScoreVariance(intensity_residual, points, config_.shading_error);
    if (distance <= 0 || intensity <= 0) return;
    const double share = distance_variance_ > 0 ? 0.1 : 1.0;
    distance_variance_ += share * (distance - distance_variance_);
    intensity_variance_ += share * (intensity - intensity_variance_);
    alpha_ = std::clamp(distance_variance_ / intensity_variance_, config_.auto_alpha_min, config_.auto_alpha_max);
}

void Photometry::Config::Describe(ConfigParameters& p) {
    p.AddChoice("alpha_mode", alpha_mode, {{"fixed", AlphaMode::kFixed}, {"auto", AlphaMode::kAuto}},
                "fixed uses alpha; auto estimates it from the residuals of the frames so far");
    p.Add("alpha", alpha, {0.0, 100.0}, "m^2",
          "photometric weight of [B14] eq. 8 (distances in metres, intensities in [0, 1]); 0 is geometry only; auto "
          "starts from it");
    p.Add("auto_alpha_min", auto_alpha_min, {1e-4, 100.0}, "m^2", "auto: the least alpha");
    p.Add("auto_alpha_max", auto_alpha_max, {1e-4, 100.0}, "m^2",
          "auto: the largest alpha; with 0.15 sdf is better on fr1 rpy, and icp-rgb depends more on how its view is predicted");
    p.Add("shading_error", shading_error, {0.0, 1.0}, "",
          "auto: what intensities are taken to be wrong by over whole image regions (vignetting, moving light, exposure); "
          "lowers alpha where shading is the only texture");
    p.Add("intensity_scale", intensity_scale, {1e-3, 10.0}, "", "Huber scale of intensities");
    p.Add("brightness", brightness,
          "estimate gain and offset of every frame, so that auto-exposure does not bend the path");
    p.Add("brightness_prior", brightness_prior, {0.0, 10.0}, "",
          "pull of gain 1 and offset 0, per unit of photometric weight; raise it where exposure is fixed");
    p.Section("shutter", [&](ConfigParameters& s) { shutter.Describe(s); });
}

}  // namespace tessera
