#include "tracking/residual_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {
namespace {

// Errors are assumed to be shared within regions of the image, but not beyond: depth deformation,
// calibration and exposure err over large parts of it (docs/information.md shows how the variance
// grows with the region).
constexpr int kRegionColumns = 5, kRegionRows = 4, kRegions = kRegionColumns * kRegionRows;
constexpr int kLeastRegions = 5;
constexpr double kMuchLarger = 2;      // times the usual error: not of this scene
constexpr double kShareOfFrame = 0.1;  // weight of a new frame in smoothed values

int RegionOf(int column, int columns, int row, int rows) {
    return row * kRegionRows / rows * kRegionColumns + column * kRegionColumns / columns;
}

// The scores (weight times Jacobian times residual) and Hessians of the image's regions.
template <int kUnknowns>
struct Regions {
    using Vector = Eigen::Matrix<double, kUnknowns, 1>;
    using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
    std::array<Vector, kRegions> scores;
    std::array<Matrix, kRegions> hessians;

    Regions() {
        scores.fill(Vector::Zero());
        hessians.fill(Matrix::Zero());
    }

    // The variance of a residual as it counts in a sum: the covariance of the regions' scores over
    // the Hessian, at the solution that fits these residuals best. For independent residuals this
    // is their variance; correlated errors of neighbours make it larger. 0 if there are too few
    // regions.
    double Variance() const {
        Vector score = Vector::Zero();
        Matrix H = Matrix::Zero(), covariance = Matrix::Zero();
        int seen = 0;
        for (std::size_t i = 0; i < kRegions; ++i) {
            score += scores[i];
            H += hessians[i];
            seen += hessians[i].trace() > 0;
        }
        if (seen < kLeastRegions) return 0;
        // Fraction of the trace. A motion that nothing observes has no score either.
        constexpr double kRegular = 1e-9;
        const Eigen::LDLT<Matrix> solver(H + kRegular * H.trace() * Matrix::Identity());
        const Vector best = solver.solve(score);
        for (std::size_t i = 0; i < kRegions; ++i) {
            const Vector at_best = scores[i] - hessians[i] * best;
            covariance += at_best * at_best.transpose();
        }
        return solver.solve(covariance).trace() / kUnknowns;
    }
};

// Distance variance from the sums over patches (DistanceSums). A patch's Hessian is that of its
// mean Jacobian. `shared_m` is an error of the whole patch that no residual shows.
double DistanceVariance(const ResidualEvidence& e, double shared_m) {
    Vector6d to_metres = Vector6d::Ones();
    to_metres.head<3>() /= e.scene_depth_m;
    Regions<6> regions;
    double weights = 0, weights2 = 0;
    const int columns = DistanceSums::Columns(e.arguments),
              blocks = DistanceSums::Groups(e.arguments) / 4;
    for (int block = 0; block < blocks; ++block) {
        const auto region = static_cast<std::size_t>(
            RegionOf(block % columns, columns, block / columns, blocks / columns));
        for (int patch = 4 * block; patch < 4 * block + 4; ++patch) {
            const double* const s = e.sums.distances.data() + patch * DistanceSums::kSums;
            if (s[0] <= 0) continue;
            const Vector6d jacobian =
                to_metres.asDiagonal() * Eigen::Map<const Vector6d>(s + DistanceSums::kJacobian);
            regions.scores[region] +=
                to_metres.asDiagonal() * Eigen::Map<const Vector6d>(s + DistanceSums::kScore);
            regions.hessians[region] += jacobian * jacobian.transpose() / s[0];
            weights += s[0];
            weights2 += s[0] * s[0];
        }
    }
    const double variance = regions.Variance();
    return variance > 0 ? variance + shared_m * shared_m * weights2 / weights : 0;
}

// Intensity variance from ScoreSums, whose scores are residual times image gradient over depth.
// Errors at edges, where the gradient is large, count by their pull on the pose. Adds the error
// that a whole block shares (`shading_error`, intensities in [0, 1]). That error hardly pulls where
// texture has gradients of all signs, but strongly where shading is the only gradient, and
// residuals against a map of the same shading do not show it. `texture`: the fraction of the map's
// gradients that the frame's gradients confirm; the noise of the two is independent.
double IntensityVariance(const ResidualEvidence& e, double shading_error, double& texture) {
    Regions<2> regions;
    double shading_scores2 = 0, information = 0, both = 0, map2 = 0;
    const int columns = ScoreSums::Columns(e.arguments), blocks = ScoreSums::Groups(e.arguments);
    for (int block = 0; block < blocks; ++block) {
        const auto region = static_cast<std::size_t>(
            RegionOf(block % columns, columns, block / columns, blocks / columns));
        const double* const s = e.sums.scores.data() + block * ScoreSums::kSums;
        regions.scores[region] += Eigen::Vector2d(s[0], s[1]);
        regions.hessians[region] += 0.5 * s[4] * Eigen::Matrix2d::Identity();
        shading_scores2 += s[2] * s[2] + s[3] * s[3];
        information += s[4];
        both += s[5];
        map2 += s[6];
    }
    const double variance = regions.Variance();
    if (variance <= 0 || map2 <= 0) return 0;
    texture = std::clamp(both / map2, 0.0, 1.0);
    return variance + shading_error * shading_error * shading_scores2 / information;
}

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
         {gain_, offset_, scales_.distance_m2, scales_.intensity, scales_.texture, scales_.alpha})
        state.Put(value);
    shutter_.SaveState(state);
}

bool ResidualModel::LoadState(StateReader& state) {
    constexpr double kLargest = 1e6;
    for (double* value : {&gain_, &offset_, &scales_.distance_m2, &scales_.intensity,
                          &scales_.texture, &scales_.alpha})
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
    double intensity = 0, texture = 1;
    if (!evidence.sums.scores.empty())
        intensity = IntensityVariance(evidence, config_.shading_error, texture);
    if (intensity > 0) {
        Smooth(RatioWithDisagreement(evidence.distances, evidence.intensities, distance, intensity),
               scales_.alpha <= 0, scales_.alpha);
        Smooth(texture, scales_.intensity <= 0, scales_.texture);
        Smooth(intensity, scales_.intensity <= 0, scales_.intensity);
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
