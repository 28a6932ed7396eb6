#include "optimize/camera_estimator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "optimize/camera_fit.h"

namespace tessera {
namespace {

constexpr std::size_t kMostPairs = 100;
constexpr int kMostOfView = 4;
constexpr double kLeastTurn_rad = 0.035, kMostTurn_rad = 0.45;
constexpr double kLeastOverlap = 0.6;
// Cost of parallax in radians of rotation: it brings in depth errors.
constexpr double kParallax = 0.15;

struct Candidate {
    int from, to;
    double merit;
};

// Share of the points of `from` that project into the image of `to`, and their mean inverse depth.
struct PairOverlap {
    double share = 0, inverse_depth = 0;
};
PairOverlap OverlapOf(const CameraView& from, const PinholeCamera& camera,
                      const Eigen::Isometry3d& T_to_from) {
    const CameraView::Level& level = from.levels.front();
    const PinholeCamera c = Averaged(camera, level.reduction);
    int count = 0, inside = 0;
    PairOverlap overlap;
    for (std::size_t i = 0; i < level.points.size(); i += 4) {
        const CameraViewPoint& point = level.points[i];
        ++count;
        overlap.inverse_depth += 1 / point.depth_m;
        const Eigen::Vector3d q = T_to_from * c.Unproject(point.u, point.v, point.depth_m);
        if (q.z() < 0.1) continue;
        const Eigen::Vector2d pixel = c.Project(q);
        inside += pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < c.width && pixel.y() < c.height;
    }
    if (count < 20) return {};
    overlap.inverse_depth /= count;
    overlap.share = static_cast<double>(inside) / count;
    return overlap;
}

// The pairs of views that best constrain the camera. Prefers much rotation, which constrains the
// focal length, and little parallax, which does not. Uses each view in only a few pairs.
std::vector<CameraPair> ChoosePairs(const std::vector<CameraView>& views,
                                    const PinholeCamera& camera,
                                    const std::vector<Eigen::Isometry3d>& T_world_camera) {
    std::vector<Candidate> candidates;
    const int count = static_cast<int>(views.size());
    const auto motion = [&](int from, int to) -> Eigen::Isometry3d {
        return T_world_camera[static_cast<std::size_t>(to)].inverse() *
               T_world_camera[static_cast<std::size_t>(from)];
    };
    for (int from = 0; from < count; ++from)
        for (int to = 0; to < count; ++to) {
            const Eigen::Isometry3d T_to_from = motion(from, to);
            const double turn = Eigen::AngleAxisd(T_to_from.linear()).angle();
            if (turn < kLeastTurn_rad || turn > kMostTurn_rad) continue;
            const PairOverlap overlap =
                OverlapOf(views[static_cast<std::size_t>(from)], camera, T_to_from);
            if (overlap.share < kLeastOverlap) continue;
            const double parallax = T_to_from.translation().norm() * overlap.inverse_depth;
            candidates.push_back(
                {from, to, turn * std::sqrt(overlap.share) - kParallax * parallax});
        }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.merit > b.merit; });
    std::vector<int> used(views.size(), 0);
    std::vector<CameraPair> pairs;
    for (const Candidate& c : candidates) {
        int &from = used[static_cast<std::size_t>(c.from)],
            &to = used[static_cast<std::size_t>(c.to)];
        if (pairs.size() >= kMostPairs || from >= kMostOfView || to >= kMostOfView) continue;
        ++from;
        ++to;
        CameraPair pair;
        pair.from = c.from;
        pair.to = c.to;
        pair.T_to_from = motion(c.from, c.to);
        pairs.push_back(pair);
    }
    return pairs;
}

}  // namespace

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
