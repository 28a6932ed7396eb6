#include "tracking/shutter_estimator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// errors of neighbouring residuals are correlated: this many count as one
constexpr double kSharedError = 100.0;
// Per frame: each step goes only part of the way, because the pose takes the rest.
constexpr double kMemory = 0.85;

}  // namespace

void ShutterEstimator::Config::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled,
          "learn the colour image's delay and rolling shutter from the residuals; off relies on "
          "the timestamps and colour_readout_s");
    p.Add("delay_prior_s", delay_prior_s, {1e-6, 0.1}, "s",
          "standard deviation of the delay from that of the timestamps");
    p.Add("readout_prior_s", readout_prior_s, {1e-6, 0.1}, "s",
          "standard deviation of the read-out time from readout_s");
    p.Add("readout_s", readout_s, {-0.05, 0.05}, "s",
          "initial value of the colour image's read-out time, beyond colour_readout_s; "
          "calibration.check starts from the recording's own");
}

void ShutterEstimator::Reset() {
    estimate_ = {0.0, config_.enabled ? config_.readout_s : 0.0};
    information_ = Eigen::Vector2d(1.0 / (config_.delay_prior_s * config_.delay_prior_s),
                                   1.0 / (config_.readout_prior_s * config_.readout_prior_s))
                       .asDiagonal();
}

void ShutterEstimator::SaveState(StateWriter& state) const {
    state.Put(estimate_);
    state.Put(information_);
}

bool ShutterEstimator::LoadState(StateReader& state) {
    constexpr double kLongest_s = 1;
    const bool read =
        state.Get(estimate_) && state.Get(information_) && estimate_.norm() <= kLongest_s;
    if (!config_.enabled) Reset();
    return read;
}

bool ShutterEstimator::Wants(const FrameMotion& motion, double residual_scale) const {
    return config_.enabled && !motion.twist_per_s.isZero() && residual_scale > 0;
}

// One Gauss-Newton step on all frames so far, of which only the newest still has a gradient:
// recursive least squares.
void ShutterEstimator::Update(const std::vector<double>& sums, double residual_scale) {
    Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (std::size_t at = 0; at < sums.size(); at += ShutterSums::kSums) {
        H += (Eigen::Matrix2d() << sums[at], sums[at + 1], sums[at + 1], sums[at + 2]).finished();
        g += Eigen::Vector2d(sums[at + 3], sums[at + 4]);
    }
    const double scale = ShutterSums::kRowStep * ShutterSums::kColumnStep /
                         (kSharedError * residual_scale * residual_scale);
    information_ = kMemory * information_ + scale * H;
    const Eigen::Vector2d step = information_.inverse() * (-scale * g);
    if (!step.allFinite()) return;
    estimate_ += step;
    estimate_(0) = std::clamp(estimate_(0), -0.03, 0.03);
    estimate_(1) = std::clamp(estimate_(1), -0.05, 0.05);
}

}  // namespace tessera
