#include "optimize/depth_distortion_estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/quantile.h"
#include "core/se3.h"
#include "optimize/depth_distortion_fit.h"

namespace tessera {
namespace {

constexpr std::size_t kMostDepthPairs = 200;
// Of a pair: rotation, and translation as a share of the depth.
constexpr double kLeastApart_rad = 0.1, kMostApart_rad = 0.7, kLeastShift = 0.1, kMostShift = 0.6;
// In standard deviations. What is left after the correction is then a ninth of the error's square.
constexpr double kSure = 3;
// Of the noise, which is taken to be at least this. Noisy cameras seem to have errors of the size
// of their noise, and exact ones of half a millimetre at 1 m.
constexpr double kAboveNoise = 2, kLeastNoise_per_m = 0.0005;

}  // namespace

bool DepthDistortionEstimate::shown() const {
    return rms_per_m >
           std::max(kSure * sigma_per_m, kAboveNoise * std::max(noise_per_m, kLeastNoise_per_m));
}

std::string DepthDistortionText(const DepthDistortionEstimate& estimate) {
    return fmt::format(
        "depth is up to {:.0f} mm wrong at 1 m, depending on the place in the image ({:.1f} +- "
        "{:.1f} mm rms)",
        1000 * estimate.largest_per_m, 1000 * estimate.rms_per_m, 1000 * estimate.sigma_per_m);
}

DepthDistortionEstimator::DepthDistortionEstimator(const PinholeCamera& camera)
    : camera_(camera), aligner_({}, camera) {}

void DepthDistortionEstimator::StartPart() {
    ++part_;
    first_of_part_ = true;
    aligner_.Clear();
}

void DepthDistortionEstimator::Add(const Frame& frame) {
    if (frame.colour.empty()) return;
    PrepareFrame(frame, {}, prepared_);
    const Eigen::Isometry3d T_last_current =
        aligner_.Align(prepared_, Eigen::Isometry3d::Identity());
    T_part_camera_.push_back(first_of_part_ ? Eigen::Isometry3d::Identity()
                                            : Normalised(T_part_camera_.back() * T_last_current));
    first_of_part_ = false;
    part_of_.push_back(part_);
    depth_m_.push_back(MedianDepth(prepared_.depth_m));
    views_.push_back(MakeDepthView(frame.depth_m, camera_));
}

std::optional<DepthDistortionEstimate> DepthDistortionEstimator::Estimate() const {
    std::vector<DepthPair> candidates;
    for (std::size_t from = 0; from < views_.size(); ++from)
        for (std::size_t to = 0; to < views_.size(); ++to) {
            if (part_of_[from] != part_of_[to] || !(depth_m_[from] > 0)) continue;
            const Eigen::Isometry3d T = T_part_camera_[to].inverse() * T_part_camera_[from];
            const double turn = Eigen::AngleAxisd(T.linear()).angle(),
                         shift = T.translation().norm() / depth_m_[from];
            if (turn > kMostApart_rad || shift > kMostShift ||
                (turn < kLeastApart_rad && shift < kLeastShift))
                continue;
            candidates.push_back({static_cast<int>(from), static_cast<int>(to), T});
        }
    std::vector<DepthPair> pairs;
    const std::size_t count = std::min(kMostDepthPairs, candidates.size());
    for (std::size_t i = 0; i < count; ++i)
        pairs.push_back(candidates[i * candidates.size() / count]);
    DepthDistortionFit fit = FitDepthDistortion(views_, camera_, pairs);
    if (fit.pairs == 0) return std::nullopt;
    DepthDistortionEstimate estimate;
    estimate.rms_per_m = fit.rms_per_m;
    estimate.sigma_per_m = fit.sigma_per_m;
    estimate.noise_per_m = fit.noise_per_m;
    estimate.pairs = fit.pairs;
    for (const float error : fit.distortion.per_m)
        estimate.largest_per_m =
            std::max(estimate.largest_per_m, static_cast<double>(std::abs(error)));
    estimate.found = std::move(fit.distortion);
    return estimate;
}

}  // namespace tessera
