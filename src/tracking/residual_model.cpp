#include "tracking/residual_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tracking/residual_errors.h"

namespace tessera {
namespace {

constexpr double kMuchLarger = 2;      // times the usual error: not of this scene
constexpr double kShareOfFrame = 0.1;  // weight of a new frame in smoothed values

// The ratio of the variances, including the disagreement of the two kinds about the pose. The
// disagreement is also their error, which no scatter within one kind shows (calibration, time,
// deformation of the whole image). It is shared between them at the pose where both pull according
// to their own errors, whatever alpha found the present one.
double RatioWithDisagreement(const PoseTerm& distances, const PoseTerm& intensities,
                             double distance, double intensity) {
    constexpr double kRegular = 1e-9;  // of the trace
    const double alpha = distance / intensity;
    const Matrix6d H = distances.H + alpha * intensities.H;
    const Vector6d to_both = (H + kRegular * H.trace() * Matrix6d::Identity())
                                 .ldlt()
                                 .solve(-(distances.g + alpha * intensities.g));
    // A mean over the six motions, as in Regions::Variance.
    const auto pull = [&](const PoseTerm& term) {
        const Vector6d score = term.g + term.H * to_both;
        return score.dot((term.H + kRegular * term.H.trace() * Matrix6d::Identity())
                             .ldlt()
                             .solve(score)) /
               6;
    };
    return (distance + pull(distances)) / (intensity + pull(intensities));
}

void Smooth(double measured, bool first, double& value) {
    value += (first ? 1.0 : kShareOfFrame) * (measured - value);
}

}  // namespace

ResidualModel::ResidualModel(const Config& config) : config_(config), shutter_(config.shutter) {
    Reset();
}

void ResidualModel::Reset() {
    gain_ = 1;
    offset_ = 0;
    usual_rms_ = 0;
    contradicted_ = false;
    scales_ = {};
    scatter_ = 0;
    shutter_.Reset();
}

void ResidualModel::SetAlpha(bool automatic, double alpha) {
    config_.alpha_mode = automatic ? AlphaMode::kAuto : AlphaMode::kFixed;
    if (!automatic) config_.alpha = alpha;
}

// Each residual's weight is the inverse of its variance as it counts in the sum, so alpha in [B14]
// eq. 8 is the ratio of the two. Plain variances would overestimate the information from geometry
// ten times.
double ResidualModel::alpha() const {
    if (config_.alpha_mode == AlphaMode::kFixed || scales_.alpha <= 0) return config_.alpha;
    return std::min(scales_.alpha, config_.auto_alpha_max);
}

void ResidualModel::SaveState(StateWriter& state) const {
    for (const double value :
         {gain_, offset_, scales_.distance_m2, scatter_, scales_.texture, scales_.alpha})
        state.Put(value);
    shutter_.SaveState(state);
}

bool ResidualModel::LoadState(StateReader& state) {
    constexpr double kLargest = 1e6;
    for (double* value :
         {&gain_, &offset_, &scales_.distance_m2, &scatter_, &scales_.texture, &scales_.alpha})
        if (!state.Get(*value) || !(std::abs(*value) <= kLargest)) return false;
    return shutter_.LoadState(state);
}

FrameMotion ResidualModel::Timed(FrameMotion motion) const {
    motion.colour_delay_s += shutter_.delay_s();
    motion.colour_readout_s += shutter_.readout_s();
    return motion;
}

bool ResidualModel::TakesForShading(const PoseSums& sums) const {
    return config_.remove_shading &&
           (usual_rms_ <= 0 || IntensityRms(sums) < kMuchLarger * usual_rms_);
}

// By the share of the map's image gradients that the frame shows: less than 1 if it is blurred, 0
// if it is blank or of something else.
bool ResidualModel::Contradicts(const ResidualSums& sums, double intensity_rms) {
    if (config_.doubt_contrast <= 0 || usual_rms_ <= 0 ||
        (!contradicted_ && intensity_rms < kMuchLarger * usual_rms_))
        return false;
    double both = 0, map2 = 0;
    for (std::size_t at = 0; at < sums.scores.size(); at += ScoreSums::kSums) {
        both += sums.scores[at + 5];
        map2 += sums.scores[at + 6];
    }
    return contradicted_ = both < config_.doubt_contrast * map2;
}

void ResidualModel::LearnScales(const ResidualEvidence& evidence) {
    const double distance =
        DistanceVariance(evidence, config_.surface_error_voxels * evidence.voxel_size_m);
    if (distance <= 0) return;
    IntensityErrors errors;
    if (!evidence.sums.scores.empty()) errors = IntensityErrorsOf(evidence, config_.shading_error);
    if (errors.variance > 0) {
        Smooth(RatioWithDisagreement(evidence.distances, evidence.intensities, distance,
                                     errors.variance),
               scales_.alpha <= 0, scales_.alpha);
        Smooth(errors.scatter, scatter_ <= 0, scatter_);
        // Not smoothed: the camera may turn to a bare wall within a few frames.
        scales_.intensity = scatter_ + errors.shading;
        scales_.texture = errors.texture;
    }
    Smooth(distance, scales_.distance_m2 <= 0, scales_.distance_m2);
}

void ResidualModel::LearnColour(const TrackResult& result, const ResidualSums& sums,
                                double rms_with_shading) {
    gain_ = result.gain;
    offset_ = result.offset;
    // What is compared with it may be shading, so it must contain the shading that is usual.
    Smooth(rms_with_shading > 0 ? rms_with_shading : result.intensity_rms, usual_rms_ <= 0,
           usual_rms_);
    if (!sums.shutter.empty() && !result.degenerate)
        shutter_.Update(sums.shutter, result.intensity_rms);
}

}  // namespace tessera
