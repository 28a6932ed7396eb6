#include "tracking/track_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera {

namespace {

using L = SumLayout;

std::string Misfit(const TrackResult& result) {
    return fmt::format("only {:.0f} % of the depth fits the map", 100 * result.inlier_fraction);
}

double InnovationOf(const Eigen::Isometry3d& T_world_expected,
                    const Eigen::Isometry3d& T_world_camera) {
    return (T_world_expected.inverse() * T_world_camera).translation().norm();
}

}  // namespace

bool TrackJudge::Fits(std::int64_t points, const PoseSums& sums, TrackResult& result) const {
    const double known = sums[L::kKnown];
    result.known_fraction = known / static_cast<double>(std::max<std::int64_t>(points, 1));
    result.inlier_fraction = known > 0 ? sums[L::kInliers] / known : 0;
    if (sums[L::kDistanceWeight] > 0) {
        result.distance_rms_m = std::sqrt(sums[L::kDistanceError] / sums[L::kDistanceWeight]);
        result.band_m = std::sqrt(sums[L::kBand] / sums[L::kDistanceWeight]);
    }
    result.intensity_rms = IntensityRms(sums);
    if (known <= 0)
        result.reason = "no depth where the map is known";
    else if (result.known_fraction < config_.min_known_fraction)
        result.reason =
            fmt::format("only {:.0f} % of the depth lies in the map", 100 * result.known_fraction);
    else if (result.inlier_fraction < config_.min_inlier_fraction)
        result.reason = Misfit(result);
    if (result.reason.empty()) return true;
    result.status = TrackStatus::kLost;
    return false;
}

void TrackJudge::Judge(const TrackInput& input, TrackResult& result) const {
    // Small voxels make a motion no less known than it is: a pose known to within this is tracked.
    constexpr double kKnown_m = 0.005;
    result.degenerate =
        result.uncertainty_m >
        std::max(kKnown_m, config_.degenerate_voxels * input.map.config().voxel_size_m);
    const Eigen::Isometry3d& T_world_expected = input.T_world_camera_starts.front();
    result.innovation_m = InnovationOf(T_world_expected, result.T_world_camera);
    result.innovation_rad = RotationAngle(T_world_expected, result.T_world_camera);
    constexpr double kLeast = 1e-6;  // a limit may be 0
    result.innovation_share = result.innovation_m / std::max(config_.good_innovation_m, kLeast) +
                              result.innovation_rad / std::max(config_.good_innovation_rad, kLeast);
    SetStatus(input, result);
}

bool TrackJudge::Follows(const Eigen::Isometry3d& T_world_expected,
                         const Eigen::Isometry3d& T_world_camera) const {
    return InnovationOf(T_world_expected, T_world_camera) <= config_.good_innovation_m &&
           RotationAngle(T_world_expected, T_world_camera) <= config_.good_innovation_rad;
}

void TrackJudge::SetStatus(const TrackInput& input, TrackResult& result) const {
    const auto because = [&](TrackStatus status, std::string reason) {
        result.status = status;
        result.reason = std::move(reason);
    };
    constexpr TrackStatus kPoor = TrackStatus::kPoor;
    const Eigen::Isometry3d jump = input.T_world_camera_last.inverse() * result.T_world_camera;
    const double moved_m = jump.translation().norm();
    const double turned_rad = RotationAngle(input.T_world_camera_last, result.T_world_camera);
    const int frames = input.frames_since_last;
    if (input.since_last_s > 0 &&
        (moved_m > frames * config_.max_jump_m || turned_rad > frames * config_.max_jump_rad)) {
        result.unexpected = !result.degenerate;
        return because(TrackStatus::kLost,
                       fmt::format("jumped by {:.2f} m and {:.2f} rad", moved_m, turned_rad));
    }
    if (result.inlier_fraction < config_.good_inlier_fraction)
        return because(kPoor, Misfit(result));
    if (result.distance_rms_m > config_.good_distance_share * result.band_m)
        return because(
            kPoor, fmt::format("the depth is {:.1f} cm off the map", 100 * result.distance_rms_m));
    if (!Follows(input.T_world_camera_starts.front(), result.T_world_camera)) {
        result.unexpected = !result.degenerate;
        return because(kPoor, fmt::format("{:.2f} m and {:.2f} rad from the predicted pose",
                                          result.innovation_m, result.innovation_rad));
    }
    result.status = TrackStatus::kGood;
}

void TrackJudge::Config::Describe(ConfigParameters& p) {
    p.Add("degenerate_voxels", degenerate_voxels, {0.0, 100.0}, "voxels",
          "a frame is degenerate if the standard deviation of some motion, at the scene's depth, "
          "is larger than this and larger than 5 mm");
    p.Add("expected_within_m", expected_within_m, {0.0, 1.0}, "m",
          "standard deviation of the pose that prealignment and motion model predict; motions that "
          "the frame constrains less well follow the prediction; 0 disables this");
    p.Add("min_known_fraction", min_known_fraction, {0.0, 1.0}, "",
          "tracking is lost if a smaller fraction of the depth lies in the map");
    p.Add("min_inlier_fraction", min_inlier_fraction, {0.0, 1.0}, "",
          "tracking is lost if a smaller fraction of the known depth fits within half the "
          "band");
    p.Add("good_inlier_fraction", good_inlier_fraction, {0.0, 1.0}, "",
          "the frame is not fused if a smaller fraction of the known depth fits");
    p.Add("good_distance_share", good_distance_share, {0.0, 10.0}, "",
          "the frame is not fused if the robust residual of the depth is larger than this share of "
          "the band");
    p.Add(
        "max_jump_m", max_jump_m, {0.0, 100.0}, "m",
        "tracking is lost if the camera moved farther from one frame to the next, unless the frame "
        "confirms it (doubt_misfit)");
    p.Add(
        "max_jump_rad", max_jump_rad, {0.0, 3.2}, "rad",
        "tracking is lost if the camera rotated more from one frame to the next, unless the frame "
        "confirms it (doubt_misfit)");
    p.Add("good_innovation_m", good_innovation_m, {0.0, 100.0}, "m",
          "a pose farther from the motion model's prediction is trusted only if the frame "
          "confirms it (doubt_misfit)");
    p.Add("good_innovation_rad", good_innovation_rad, {0.0, 3.2}, "rad",
          "the same for a rotation farther from the motion model's prediction");
    p.Add("doubt_misfit", doubt_misfit, {0.0, 1.0}, "",
          "after a gap in time or after frames that fitted badly, a frame is trusted only if its "
          "inlier fraction is at most this share below the usual one. It confirms a pose far from "
          "the prediction if that is so counting unknown points as outliers. 1 disables both");
    p.Add("doubt_known_fraction", doubt_known_fraction, {0.0, 1.0}, "",
          "then it is not trusted either if a smaller fraction of the depth lies in the map");
}

}  // namespace tessera
