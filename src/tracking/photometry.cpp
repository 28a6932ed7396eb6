#include "tracking/photometry.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr int kLeastKnown = kResidualBlock * kResidualBlock / 2, kLeastBlocks = 16;

// Variance of the means of blocks of neighbouring samples (DistanceSums), times the samples per block: the variance of a
// residual as it counts in a sum. For independent residuals it is their variance; errors that neighbours share
// (depth deformation, calibration, blur) make it larger. The method of batch means.
double BatchMeansVariance(const std::vector<double>& sums) {
    double sum = 0, sum2 = 0, samples = 0, blocks = 0;
    for (std::size_t at = 0; at < sums.size(); at += DistanceSums::kSums) {
        const double known = sums[at + 1];
        if (known < kLeastKnown) continue;
        const double mean = sums[at] / known;
        sum += mean;
        sum2 += mean * mean;
        samples += known;
        ++blocks;
    }
    if (blocks < kLeastBlocks) return 0;
    return (sum2 / blocks - (sum / blocks) * (sum / blocks)) * (samples / blocks);
}

// The same for a residual whose Jacobian changes from pixel to pixel (ScoreSums): the variance of its score, residual times
// image gradient over depth, summed over a block's neighbours, over the sum of the squared
// gradients. Errors at edges, where the gradient is large, count as they pull. What a whole tile is wrong by together
// (`shading_error`, intensities in [0, 1]) is added: it hardly pulls where texture has gradients of all signs, and a lot
// where the only gradient is shading, which residuals against a map of the same shading do not show.
double ScoreVariance(const std::vector<double>& sums, double shading_error) {
    double scores2 = 0, shading_scores2 = 0, information = 0, blocks = 0;
    for (std::size_t at = 0; at < sums.size(); at += ScoreSums::kSums) {
        const double* s = sums.data() + at;
        if (s[5] < kLeastKnown) continue;
        scores2 += s[0] * s[0] + s[1] * s[1];
        shading_scores2 += s[2] * s[2] + s[3] * s[3];
        information += s[4];
        ++blocks;
    }
    if (blocks < kLeastBlocks || information <= 0) return 0;
    return (scores2 + shading_error * shading_error * shading_scores2) / information;
}

}  // namespace

Photometry::Photometry(const Config& config) : config_(config), shutter_(config.shutter) { Reset(); }

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

void Photometry::Learn(const TrackResult& result, ResidualArguments a,
                       const std::function<ResidualSums(const ResidualArguments&)>& sum) {
    gain_ = result.gain;
    offset_ = result.offset;
    if (result.alpha <= 0 || result.degenerate) return;  // where the pose is not held, it explains what it should not
    a.wants_shutter = shutter_.Wants(result.motion, result.intensity_rms);
    a.wants_alpha = config_.alpha_mode == AlphaMode::kAuto;
    if (!a.wants_shutter && !a.wants_alpha) return;
    for (int i = 0; i < 6; ++i) a.twist_per_s[i] = result.motion.twist_per_s(i);
    a.colour_delay_s = result.motion.colour_delay_s;
    a.colour_readout_s = result.motion.colour_readout_s;
    a.gain = result.gain;
    a.residual_scale = result.intensity_rms;
    const ResidualSums sums = sum(a);
    if (a.wants_shutter) shutter_.Update(sums.shutter, result.intensity_rms);
    if (a.wants_alpha) UpdateAlpha(sums);
}

// Each residual's weight is the inverse of its variance as it counts in the sum, so alpha in [B14] eq. 8 is the ratio of
// the two. Plain variances would say that the geometry knows ten times more than it does.
void Photometry::UpdateAlpha(const ResidualSums& sums) {
    const double distance = BatchMeansVariance(sums.distances);
    const double intensity = ScoreVariance(sums.scores, config_.shading_error);
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
