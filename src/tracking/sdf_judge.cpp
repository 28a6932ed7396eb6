// What one tracked frame is worth, and how the photometric weight follows the residuals.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tracking/sdf_tracker.h"

namespace tessera {
namespace {

using L = SdfSumLayout;

// Variance of the means of kBlock x kBlock neighbouring samples, times the samples per block: the variance of a
// residual as it counts in a sum. For independent residuals it is their variance; errors that neighbours share
// (depth deformation, calibration, blur) make it larger. The method of batch means.
double BatchMeansVariance(const std::vector<float>& residuals, int width, int height) {
    constexpr int kBlock = 16, kLeast = kBlock * kBlock / 2;
    double sum = 0, sum2 = 0, samples = 0;
    std::int64_t blocks = 0;
    for (int by = 0; by + kBlock <= height; by += kBlock)
        for (int bx = 0; bx + kBlock <= width; bx += kBlock) {
            double total = 0;
            int known = 0;
            for (int y = by; y < by + kBlock; ++y)
                for (int x = bx; x < bx + kBlock; ++x) {
                    const float r = residuals[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                              static_cast<std::size_t>(x)];
                    if (std::isnan(r)) continue;
                    total += r;
                    ++known;
                }
            if (known < kLeast) continue;
            const double mean = total / known;
            sum += mean;
            sum2 += mean * mean;
            samples += known;
            ++blocks;
        }
    if (blocks < 16) return 0;
    const auto n = static_cast<double>(blocks);
    return (sum2 / n - (sum / n) * (sum / n)) * (samples / n);
}

}  // namespace

void SdfTracker::Judge(const TrackInput& input, const SdfSums& sums, const SdfStep& step,
                       TrackResult& result) const {
    const auto points = static_cast<double>(std::max<std::int64_t>(points_[0].valid(), 1));
    const double known = sums[L::kKnown];
    result.known_fraction = known / points;
    result.inlier_fraction = known > 0 ? sums[L::kInliers] / known : 0;
    if (sums[L::kDistanceWeight] > 0)
        result.distance_rms_m = std::sqrt(sums[L::kDistanceError] / sums[L::kDistanceWeight]);
    if (sums[L::kIntensityWeight] > 0)
        result.intensity_rms = std::sqrt(sums[L::kIntensityError] / sums[L::kIntensityWeight]);
    result.smallest_eigenvalue = step.smallest_eigenvalue;
    result.degenerate = step.held_directions > 0;

    const Eigen::Isometry3d jump = input.T_world_camera_last.inverse() * result.T_world_camera;
    const double moved_m = jump.translation().norm();
    const double turned_rad = RotationAngle(input.T_world_camera_last, result.T_world_camera);
    result.status = TrackStatus::kLost;
    if (!step.valid)
        result.reason = "no depth where the map is known";
    else if (result.known_fraction < config_.min_known_fraction)
        result.reason = fmt::format("only {:.0f} % of the depth lies in the map", 100 * result.known_fraction);
    else if (result.inlier_fraction < config_.min_inlier_fraction)
        result.reason = fmt::format("only {:.0f} % of the depth fits the map", 100 * result.inlier_fraction);
    else if (input.since_last_s > 0 && (moved_m > config_.max_jump_m || turned_rad > config_.max_jump_rad))
        result.reason = fmt::format("jumped by {:.2f} m and {:.2f} rad", moved_m, turned_rad);
    else if (result.degenerate) {
        result.status = TrackStatus::kPoor;
        result.reason = fmt::format("degenerate: {} of 6 motions are not held by what is in view",
                                    step.held_directions);
    } else if (result.inlier_fraction < config_.good_inlier_fraction) {
        result.status = TrackStatus::kPoor;
        result.reason = fmt::format("only {:.0f} % of the depth fits the map", 100 * result.inlier_fraction);
    } else {
        result.status = TrackStatus::kGood;
    }
}

// Each residual's weight is the inverse of its variance as it counts in the sum, so alpha in [B14] eq. 8 is the ratio of
// the two. Plain variances would say that the geometry knows ten times more than it does.
void SdfTracker::UpdateAlpha(const SdfPoints& points) {
    const double distance = BatchMeansVariance(distance_residual_, points.width(), points.height());
    const double intensity = BatchMeansVariance(intensity_residual_, points.width(), points.height());
    if (distance <= 0 || intensity <= 0) return;
    const double share = distance_variance_ > 0 ? 0.1 : 1.0;
    distance_variance_ += share * (distance - distance_variance_);
    intensity_variance_ += share * (intensity - intensity_variance_);
    alpha_ = std::clamp(distance_variance_ / intensity_variance_, config_.auto_alpha_min, config_.auto_alpha_max);
}

void SdfTracker::Config::Describe(ConfigParameters& p) {
    p.AddChoice("alpha_mode", alpha_mode, {{"fixed", AlphaMode::kFixed}, {"auto", AlphaMode::kAuto}},
                "fixed uses alpha; auto estimates it from the residuals of the frames so far");
    p.Add("alpha", alpha, {0.0, 100.0}, "m^2",
          "photometric weight of [B14] eq. 8 (distances in metres, intensities in [0, 1]); 0 is geometry only; auto "
          "starts from it");
    p.Add("auto_alpha_min", auto_alpha_min, {1e-4, 100.0}, "m^2", "auto: the least alpha");
    p.Add("auto_alpha_max", auto_alpha_max, {1e-4, 100.0}, "m^2",
          "auto: the largest alpha; where nothing has texture, small photometric residuals say little, and vignetting "
          "would count as texture");
    p.Add("distance_scale_m", distance_scale_m, {1e-4, 1.0}, "m",
          "Huber scale of distances: larger residuals count linearly");
    p.Add("intensity_scale", intensity_scale, {1e-3, 10.0}, "", "Huber scale of intensities");
    p.Add("depth_exponent", depth_exponent, {0.0, 4.0}, "",
          "a point's weight is (1 m / depth)^this: 4 is the inverse variance of structured light, 0 is [B14]");
    p.Add("normalise", normalise,
          "divide the field's distance by its gradient's length: distances measured along slanted rays are too long; "
          "off is [B14]");
    p.Add("finest_step_px", finest_step_px, {1, 16}, "px",
          "the finest level takes every so-manieth pixel in both directions");
    p.Add("levels", levels, {1, 5}, "", "coarse to fine: each level doubles the step");
    p.Add("coarse_iterations", coarse_iterations, {1, 100}, "", "most Gauss-Newton steps on each coarse level");
    p.Add("fine_iterations", fine_iterations, {1, 100}, "", "most Gauss-Newton steps on the finest level");
    p.Add("brightness", brightness,
          "estimate gain and offset of every frame, so that auto-exposure does not bend the path");
    p.Add("brightness_prior", brightness_prior, {0.0, 10.0}, "",
          "pull of gain 1 and offset 0, per unit of photometric weight; raise it where exposure is fixed");
    p.Add("min_eigenvalue", min_eigenvalue, {0.0, 0.1}, "",
          "motions whose share of the normalised Hessian is smaller are held and the frame is called degenerate");
    p.Add("min_known_fraction", min_known_fraction, {0.0, 1.0}, "",
          "lost if a smaller share of the depth lies in the map");
    p.Add("min_inlier_fraction", min_inlier_fraction, {0.0, 1.0}, "",
          "lost if a smaller share of the known depth fits within half the truncation");
    p.Add("good_inlier_fraction", good_inlier_fraction, {0.0, 1.0}, "",
          "tracked, but not fused, if a smaller share fits");
    p.Add("max_jump_m", max_jump_m, {0.0, 100.0}, "m", "lost if the camera moved farther since the last frame");
    p.Add("max_jump_rad", max_jump_rad, {0.0, 3.2}, "rad", "lost if the camera turned more since the last frame");
    p.Section("shutter", [&](ConfigParameters& s) { shutter.Describe(s); });
}

}  // namespace tessera
