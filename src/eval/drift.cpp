#include "eval/drift.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "eval/alignment.h"

namespace tessera {
namespace {

struct Along {
    double stamp_s = 0, way_m = 0;  // of the reference's path so far
    Eigen::Isometry3d reference, estimate;
};

std::vector<Along> PosesAlong(const std::vector<StampedPose>& reference,
                              const std::vector<StampedPose>& estimate) {
    std::vector<Along> poses;
    for (const PosePair& pair : AssociateByTime(reference, estimate)) {
        Along next{estimate[pair.estimate].stamp_s, 0, reference[pair.reference].T_world_camera,
                   estimate[pair.estimate].T_world_camera};
        if (!poses.empty())
            next.way_m =
                poses.back().way_m +
                (next.reference.translation() - poses.back().reference.translation()).norm();
        poses.push_back(next);
    }
    return poses;
}

Eigen::Isometry3d RelativeError(const Along& from, const Along& to) {
    return (from.reference.inverse() * to.reference).inverse() *
           (from.estimate.inverse() * to.estimate);
}

double Angle(const Eigen::Isometry3d& T) { return RotationAngle(Eigen::Isometry3d::Identity(), T); }

DriftResult::OverDistance OverDistanceOf(const std::vector<Along>& poses, double distance_m) {
    constexpr double kTooFar = 1.1;  // a gap in the estimate
    DriftResult::OverDistance result{distance_m, 0, 0, 0};
    std::size_t end = 0;
    for (const Along& begin : poses) {
        while (end < poses.size() && poses[end].way_m < begin.way_m + distance_m) ++end;
        if (end == poses.size()) break;
        if (poses[end].way_m > begin.way_m + kTooFar * distance_m) continue;
        const Eigen::Isometry3d error = RelativeError(begin, poses[end]);
        const double angle = Angle(error);
        result.trans_fraction += error.translation().squaredNorm();
        result.rot_rad_per_m += angle * angle;
        ++result.pairs;
    }
    if (result.pairs == 0) return result;
    const auto count = static_cast<double>(result.pairs);
    result.trans_fraction = std::sqrt(result.trans_fraction / count) / distance_m;
    result.rot_rad_per_m = std::sqrt(result.rot_rad_per_m / count) / distance_m;
    return result;
}

std::vector<Along> EveryTenCentimetres(const std::vector<Along>& poses) {
    constexpr double kStep_m = 0.1;
    std::vector<Along> some;
    for (const Along& pose : poses)
        if (some.empty() || pose.way_m >= some.back().way_m + kStep_m) some.push_back(pose);
    return some;
}

// Sorted by x, so that only poses with nearly the same x are compared.
std::vector<DriftResult::Revisit> RevisitsOf(std::vector<Along> poses) {
    constexpr double kNear_m = 0.5, kNear_rad = 0.5, kBetween_m = 5;
    const auto x = [](const Along& pose) { return pose.reference.translation().x(); };
    std::ranges::sort(poses, {}, x);
    std::vector<DriftResult::Revisit> revisits;
    for (const Along& again : poses) {
        const Along* nearest = nullptr;
        double least_m = kNear_m;
        for (auto first = std::ranges::lower_bound(poses, x(again) - kNear_m, {}, x);
             first != poses.end() && x(*first) <= x(again) + kNear_m; ++first) {
            if (first->way_m > again.way_m - kBetween_m) continue;
            const double off_m =
                (first->reference.translation() - again.reference.translation()).norm();
            if (off_m > least_m || RotationAngle(first->reference, again.reference) > kNear_rad)
                continue;
            least_m = off_m;
            nearest = &*first;
        }
        if (nearest == nullptr) continue;
        const Eigen::Isometry3d error = RelativeError(*nearest, again);
        revisits.push_back(
            {nearest->stamp_s, again.stamp_s, error.translation().norm(), Angle(error)});
    }
    std::ranges::sort(revisits, {}, &DriftResult::Revisit::again_s);
    return revisits;
}

}  // namespace

Result<DriftResult> EvaluateDrift(const std::vector<StampedPose>& reference,
                                  const std::vector<StampedPose>& estimate) {
    const std::vector<Along> poses = PosesAlong(reference, estimate);
    if (poses.size() < 2)
        return Status::Error(
            fmt::format("{} of its {} poses have a reference at their time; 2 are needed",
                        poses.size(), estimate.size()));
    DriftResult result;
    result.path_m = poses.back().way_m;
    for (double decade_m = 1; decade_m <= result.path_m; decade_m *= 10)
        for (const double of : {1.0, 2.0, 5.0})
            if (const auto over = OverDistanceOf(poses, of * decade_m); over.pairs > 0)
                result.over_distance.push_back(over);
    result.revisits = RevisitsOf(EveryTenCentimetres(poses));
    std::vector<double> trans_m, rot_rad;
    for (const DriftResult::Revisit& revisit : result.revisits) {
        trans_m.push_back(revisit.trans_m);
        rot_rad.push_back(revisit.rot_rad);
    }
    result.revisit_m = Summarise(std::move(trans_m));
    result.revisit_rad = Summarise(std::move(rot_rad));
    return result;
}

std::string DriftJson(const DriftResult& result) {
    const double degrees = 180 / std::numbers::pi;
    nlohmann::ordered_json over = nlohmann::ordered_json::array();
    for (const DriftResult::OverDistance& d : result.over_distance)
        over.push_back({{"distance_m", d.distance_m},
                        {"pairs", d.pairs},
                        {"trans_percent", 100 * d.trans_fraction},
                        {"rot_deg_per_m", degrees * d.rot_rad_per_m}});
    const nlohmann::ordered_json json = {{"path_m", result.path_m},
                                         {"over_distance", over},
                                         {"revisits",
                                          {{"count", result.revisits.size()},
                                           {"trans_rmse_m", result.revisit_m.rmse},
                                           {"trans_max_m", result.revisit_m.max},
                                           {"rot_rmse_deg", degrees * result.revisit_rad.rmse}}}};
    return json.dump(2) + "\n";
}

}  // namespace tessera
