#include "eval/rpe.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace tessera {
namespace {

// Index of the pose nearest in time; of two equally near, the later. `poses` must not be empty.
std::size_t NearestInTime(const std::vector<StampedPose>& poses, double stamp_s) {
    const auto after = std::lower_bound(
        poses.begin(), poses.end(), stamp_s,
        [](const StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
    const auto index = static_cast<std::size_t>(after - poses.begin());
    if (after == poses.begin()) return 0;
    if (after == poses.end()) return index - 1;
    return stamp_s - poses[index - 1].stamp_s < after->stamp_s - stamp_s ? index - 1 : index;
}

double MedianInterval(const std::vector<StampedPose>& poses) {
    std::vector<double> intervals;
    for (std::size_t i = 1; i < poses.size(); ++i)
        intervals.push_back(poses[i].stamp_s - poses[i - 1].stamp_s);
    return Summarise(std::move(intervals)).median;
}

Eigen::Isometry3d Motion(const StampedPose& from, const StampedPose& to) {
    return from.T_world_camera.inverse() * to.T_world_camera;
}

}  // namespace

Result<RpeResult> EvaluateRpe(const std::vector<StampedPose>& reference,
                              const std::vector<StampedPose>& estimate, const RpeOptions& options) {
    if (!(options.delta_s > 0) || !std::isfinite(options.delta_s))
        return Status::Error(fmt::format("delta of {} s must be greater than 0", options.delta_s));
    if (reference.size() < 2)
        return Status::Error("the reference trajectory has fewer than two poses");
    if (estimate.size() < 2)
        return Status::Error("the estimated trajectory has fewer than two poses");

    const double max_difference_s = 2 * MedianInterval(reference);
    RpeResult result;
    result.delta_s = options.delta_s;
    std::vector<double> translations, rotations;
    for (const StampedPose& begin : estimate) {
        const std::size_t j = NearestInTime(estimate, begin.stamp_s + options.delta_s);
        const StampedPose& end = estimate[j];
        const double miss_s = std::abs(end.stamp_s - begin.stamp_s - options.delta_s);
        if (j + 1 == estimate.size() || miss_s > 0.1 * options.delta_s) continue;
        const StampedPose& ref_begin = reference[NearestInTime(reference, begin.stamp_s)];
        const StampedPose& ref_end = reference[NearestInTime(reference, end.stamp_s)];
        if (std::abs(ref_begin.stamp_s - begin.stamp_s) > max_difference_s ||
            std::abs(ref_end.stamp_s - end.stamp_s) > max_difference_s)
            continue;
        const Eigen::Isometry3d error = Motion(begin, end).inverse() * Motion(ref_begin, ref_end);
        translations.push_back(error.translation().norm());
        rotations.push_back(RotationAngle(Eigen::Isometry3d::Identity(), error));
        result.pairs.push_back({begin.stamp_s, end.stamp_s, translations.back(), rotations.back()});
    }
    if (result.pairs.empty())
        return Status::Error(fmt::format(
            "no two poses of the estimate ({:.3f} to {:.3f} s) are {} s apart and have a reference "
            "({:.3f} to {:.3f} s)",
            estimate.front().stamp_s, estimate.back().stamp_s, options.delta_s,
            reference.front().stamp_s, reference.back().stamp_s));
    result.trans_m = Summarise(std::move(translations));
    result.rot_rad = Summarise(std::move(rotations));
    return result;
}

std::string RpeJson(const RpeResult& result) {
    constexpr double degrees = 180 / std::numbers::pi;
    const nlohmann::ordered_json json = {{"rpe_trans_rmse_m", result.trans_m.rmse},
                                         {"rpe_trans_median_m", result.trans_m.median},
                                         {"rpe_trans_max_m", result.trans_m.max},
                                         {"rpe_rot_rmse_deg", result.rot_rad.rmse * degrees},
                                         {"rpe_rot_median_deg", result.rot_rad.median * degrees},
                                         {"rpe_rot_max_deg", result.rot_rad.max * degrees},
                                         {"pairs", result.pairs.size()},
                                         {"delta_s", result.delta_s}};
    return json.dump(2) + "\n";
}

}  // namespace tessera
