#include "optimize/keyframes.h"

#include <algorithm>
#include <cmath>

#include "core/se3.h"

namespace tessera {

double ViewOverlap(const DepthImage& depth_m, const PinholeCamera& view,
                   const Eigen::Isometry3d& T_other_this) {
    constexpr double kMaxScale = 1.2;
    int points = 0, seen = 0;
    for (int y = 0; y < depth_m.height(); ++y)
        for (int x = 0; x < depth_m.width(); ++x) {
            const float z = depth_m(x, y);
            if (z <= 0) continue;
            ++points;
            const Eigen::Vector3d p_other = T_other_this * view.Unproject(x, y, z);
            if (p_other.z() < z / kMaxScale || p_other.z() > z * kMaxScale) continue;
            const Eigen::Vector2d uv = view.Project(p_other);
            seen += uv.x() >= -0.5 && uv.x() < view.width - 0.5 && uv.y() >= -0.5 &&
                    uv.y() < view.height - 0.5;
        }
    return points > 0 ? static_cast<double>(seen) / points : 0;
}

DepthImage ReducedDepth(const DepthImage& depth_m, int step) {
    DepthImage reduced(depth_m.width() / step, depth_m.height() / step);
    for (int y = 0; y < reduced.height(); ++y)
        for (int x = 0; x < reduced.width(); ++x)
            reduced(x, y) = depth_m(step / 2 + step * x, step / 2 + step * y);
    return reduced;
}

void Keyframes::Follow(const Eigen::Isometry3d& T_map_camera) {
    if (followed_) {
        way_m_ += (T_map_camera.translation() - T_map_last_.translation()).norm();
        turned_rad_ += RotationAngle(T_map_last_, T_map_camera);
    }
    T_map_last_ = T_map_camera;
    followed_ = true;
}

bool Keyframes::Wanted(const PreparedFrame& frame, const Eigen::Isometry3d& T_map_camera) const {
    if (keyframes_.empty()) return true;
    const DepthImage depth = ReducedDepth(frame.depth_m, kKeyframeReduction);
    return ViewOverlap(depth, camera_.Every(kKeyframeReduction),
                       last().T_map_camera.inverse() * T_map_camera) < max_overlap_;
}

Keyframe& Keyframes::Add(std::int64_t frame_index, double stamp_s, const PreparedFrame& frame,
                         const TrackResult& track, const FrameMotion& motion) {
    Keyframe next;
    next.id = size();
    next.frame_index = frame_index;
    next.stamp_s = stamp_s;
    next.T_map_camera = track.T_world_camera;
    next.features = ExtractFeatures(frame, camera_, max_features_);
    next.view = camera_.Every(kKeyframeReduction);
    next.depth_m = ReducedDepth(frame.depth_m, kKeyframeReduction);
    next.reduced = MakeReducedView(frame, camera_, motion);
    // Rows are spread evenly over the read-out. Depth's is seldom known: colour's stands for it.
    const double spread_s =
        std::max(motion.depth_readout_s, motion.colour_readout_s) / std::sqrt(12.0);
    next.skew_rad = spread_s * motion.twist_per_s.head<3>().norm();
    next.skew_m = spread_s * motion.twist_per_s.tail<3>().norm();
    next.path_length_m = way_m_;
    next.turned_rad = turned_rad_;
    next.inlier_fraction = track.inlier_fraction;
    return keyframes_.emplace_back(std::move(next));
}

void Keyframes::Resume(std::vector<Keyframe> keyframes) {
    keyframes_ = std::move(keyframes);
    if (keyframes_.empty()) return;
    way_m_ = last().path_length_m;
    turned_rad_ = last().turned_rad;
    T_map_last_ = last().T_map_camera;
    followed_ = true;
}

}  // namespace tessera
