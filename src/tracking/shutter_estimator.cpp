#include "tracking/shutter_estimator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr int kRowStep = 3, kColumnStep = 2;  // of the points: enough, and cheap
constexpr double kSharedError = 100.0;  // neighbouring residuals err together: so many count as one
constexpr double kMemory = 0.85;  // per frame: each step goes only part of the way, the pose takes the rest

// Central differences of the image at the nearest pixel; false at the border.
bool Gradient(const Image<float>& image, double u, double v, Eigen::Vector2d& gradient) {
    if (!(u >= 1 && v >= 1 && u < image.width() - 2 && v < image.height() - 2)) return false;
    const int x = static_cast<int>(u + 0.5), y = static_cast<int>(v + 0.5);
    gradient << 0.5 * (image(x + 1, y) - image(x - 1, y)), 0.5 * (image(x, y + 1) - image(x, y - 1));
    return true;
}

}  // namespace

void ShutterEstimator::Config::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled,
          "learn the colour image's delay and rolling shutter from the residuals; off trusts the time stamps and "
          "colour_readout_s");
    p.Add("delay_prior_s", delay_prior_s, {1e-6, 0.1}, "s", "how far the delay may lie from the time stamps'");
    p.Add("readout_prior_s", readout_prior_s, {1e-6, 0.1}, "s", "how long the read-out may be");
}

void ShutterEstimator::Reset() {
    estimate_.setZero();
    information_ = Eigen::Vector2d(1.0 / (config_.delay_prior_s * config_.delay_prior_s),
                                   1.0 / (config_.readout_prior_s * config_.readout_prior_s))
                       .asDiagonal();
}

void ShutterEstimator::SaveState(StateWriter& state) const {
    state.Put(estimate_);
    state.Put(information_);
}

bool ShutterEstimator::LoadState(StateReader& state) { return state.Get(estimate_) && state.Get(information_); }

// One Gauss-Newton step on all frames so far, of which only the newest has a gradient left: recursive least squares.
void ShutterEstimator::Update(const PreparedFrame& frame, const FramePoints& points,
                              const std::vector<float>& residuals, const FrameMotion& motion, double gain,
                              double residual_scale) {
    if (!config_.enabled || motion.twist_per_s.isZero() || residual_scale <= 0) return;
    const Eigen::Vector3d turn = motion.twist_per_s.head<3>(), move = motion.twist_per_s.tail<3>();
    Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (int row = 0; row < points.height(); row += kRowStep) {
        const double image_row = points.ImageRow(row);
        const double time = motion.ColourTime(image_row, camera_.height);
        const double share = image_row / camera_.height - 0.5;
        for (int column = 0; column < points.width(); column += kColumnStep) {
            const auto i = static_cast<std::size_t>(row * points.width() + column);
            const double residual = residuals[i];
            if (std::isnan(residual)) continue;
            const Eigen::Vector3d p(points.x[i], points.y[i], points.z[i]);
            const Eigen::Vector3d velocity = -(turn.cross(p) + move);  // of the point, seen from the moving camera
            const Eigen::Vector3d q = p + time * velocity;
            Eigen::Vector2d gradient;
            const Eigen::Vector2d uv = camera_.Project(q);
            if (q.z() < 0.1 || !Gradient(frame.intensity, uv.x(), uv.y(), gradient)) continue;
            const Eigen::Vector2d flow(camera_.fx * (velocity.x() - q.x() / q.z() * velocity.z()) / q.z(),
                                       camera_.fy * (velocity.y() - q.y() / q.z() * velocity.z()) / q.z());
            const double slope = -gain * gradient.dot(flow);  // d(residual)/d(time)
            const Eigen::Vector2d j(slope, slope * share);
            const double w = points.weight[i] * std::min(1.0, residual_scale / std::abs(residual));
            H += w * j * j.transpose();
            g += w * residual * j;
        }
    }
    const double scale = kRowStep * kColumnStep / (kSharedError * residual_scale * residual_scale);
    information_ = kMemory * information_ + scale * H;
    const Eigen::Vector2d step = information_.inverse() * (-scale * g);
    if (!step.allFinite()) return;
    estimate_ += step;
    estimate_(0) = std::clamp(estimate_(0), -0.03, 0.03);
    estimate_(1) = std::clamp(estimate_(1), -0.05, 0.05);
}

}  // namespace tessera
