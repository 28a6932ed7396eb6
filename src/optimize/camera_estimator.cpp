#include "optimize/camera_estimator.h"

#include <algorithm>
#include <utility>

#include "optimize/camera_fit.h"
#include "optimize/camera_pairs.h"

namespace tessera {

CameraEstimator::CameraEstimator(const PinholeCamera& camera)
    : camera_(camera), aligner_({}, camera) {}

void CameraEstimator::Add(const Frame& frame) {
    if (frame.colour.empty()) return;
    PrepareFrame(frame, {}, prepared_);
    const Eigen::Isometry3d T_last_current =
        aligner_.Align(prepared_, Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d last =
        T_world_camera_.empty() ? Eigen::Isometry3d::Identity() : T_world_camera_.back();
    T_world_camera_.push_back(Normalised(last * T_last_current));
    views_.push_back(MakeCameraView(frame));
}

// Finite difference between the previous and the next frame.
Vector6d CameraEstimator::Velocity(int view) const {
    constexpr double kLongest_s = 0.5;
    const int before = std::max(0, view - 1), after = std::min(frames() - 1, view + 1);
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    const double dt_s = views_[at(after)].stamp_s - views_[at(before)].stamp_s;
    if (!(dt_s > 0) || dt_s > kLongest_s) return Vector6d::Zero();
    return Se3Log(T_world_camera_[at(before)].inverse() * T_world_camera_[at(after)]) / dt_s;
}

std::optional<CameraEstimate> CameraEstimator::Estimate() const {
    std::vector<CameraPair> pairs = ChoosePairs(views_, camera_, T_world_camera_);
    for (CameraPair& pair : pairs) {
        pair.velocity_from = Velocity(pair.from);
        pair.velocity_to = Velocity(pair.to);
    }
    return FitCamera(views_, camera_, std::move(pairs));
}

}  // namespace tessera
