#include "optimize/camera_pairs.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

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

}  // namespace tessera
