#include "run/camera_calibrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "core/quantile.h"

namespace tessera {
namespace {

constexpr std::size_t kLeastCorners = 8;
constexpr int kCells = 5;  // in a row of the coverage
constexpr int kUnknowns = 9;

cv::Point2f ToCv(const Eigen::Vector2d& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

}  // namespace

// What OpenCV found: the camera, and the board's pose in each used view.
struct CameraCalibrator::Poses {
    cv::Mat camera, distortion, sigmas, errors;
    std::vector<cv::Mat> rotations, translations;
    std::vector<std::size_t> used;  // into views_

    // Solves with the used views. Returns the corners' error, in pixels.
    double Solve(const CameraCalibrator& c) {
        const std::vector<Eigen::Vector3d> corners = c.board_.Corners();
        std::vector<std::vector<cv::Point3f>> points;
        std::vector<std::vector<cv::Point2f>> pixels;
        for (const std::size_t i : used) {
            points.emplace_back();
            pixels.emplace_back();
            const BoardView& seen = c.views_[i].seen;
            for (std::size_t k = 0; k < seen.ids.size(); ++k) {
                const Eigen::Vector3d& p = corners[static_cast<std::size_t>(seen.ids[k])];
                points.back().emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                           0.0f);
                pixels.back().push_back(ToCv(seen.pixels[k]));
            }
        }
        return cv::calibrateCamera(points, pixels, cv::Size(c.width_, c.height_), camera,
                                   distortion, rotations, translations, sigmas, cv::noArray(),
                                   errors);
    }
    // Views in which a corner was found wrongly. Returns whether there were some.
    bool DropOutliers() {
        constexpr double kOutlier = 3;
        std::vector<double> all(errors.begin<double>(), errors.end<double>());
        const double most = kOutlier * Median(all);
        std::vector<std::size_t> kept;
        for (std::size_t i = 0; i < used.size(); ++i)
            if (all[i] <= most) kept.push_back(used[i]);
        const bool dropped = kept.size() < used.size() && kept.size() >= kLeastViews;
        if (dropped) used = std::move(kept);
        return dropped;
    }
};

bool CameraCalibrator::Add(const Frame& frame) {
    if (frame.colour.empty()) return false;
    if (views_.empty()) {
        width_ = frame.colour.width();
        height_ = frame.colour.height();
    }
    if (frame.colour.width() != width_ || frame.colour.height() != height_) return false;
    BoardView seen = FindBoard(board_, frame.colour);
    if (seen.ids.size() < kLeastCorners) return false;
    // Another view: its corners are elsewhere by a 30th of the image's width on average.
    const double least_px = width_ / 30.0;
    for (const View& view : views_) {
        double sum = 0;
        int common = 0;
        for (std::size_t i = 0; i < seen.ids.size(); ++i) {
            const auto same = std::ranges::find(view.seen.ids, seen.ids[i]);
            if (same == view.seen.ids.end()) continue;
            const auto k = static_cast<std::size_t>(same - view.seen.ids.begin());
            sum += (view.seen.pixels[k] - seen.pixels[i]).norm();
            ++common;
        }
        if (common > 0 && sum < least_px * common) return false;
    }
    std::vector<DepthSample> depth = DepthWithin(seen, frame.depth_m);
    views_.push_back({std::move(seen), std::move(depth)});
    return true;
}

std::vector<CameraCalibrator::DepthSample> CameraCalibrator::DepthWithin(
    const BoardView& seen, const DepthImage& depth_m) {
    constexpr int kStep = 4;
    std::vector<cv::Point2f> points, hull;
    for (const Eigen::Vector2d& p : seen.pixels) points.push_back(ToCv(p));
    cv::convexHull(points, hull);
    std::vector<DepthSample> samples;
    for (int y = 0; y < depth_m.height(); y += kStep)
        for (int x = 0; x < depth_m.width(); x += kStep)
            if (depth_m(x, y) > 0 &&
                cv::pointPolygonTest(
                    hull, cv::Point2f(static_cast<float>(x), static_cast<float>(y)), false) > 0)
                samples.push_back({Eigen::Vector2d(x, y), depth_m(x, y)});
    return samples;
}

double CameraCalibrator::coverage() const {
    if (views_.empty()) return 0;
    const int cell_px = std::max(1, width_ / kCells), rows = (height_ + cell_px - 1) / cell_px;
    std::set<std::pair<int, int>> cells;
    for (const View& view : views_)
        for (const Eigen::Vector2d& p : view.seen.pixels)
            cells.emplace(std::clamp(static_cast<int>(p.x()) / cell_px, 0, kCells - 1),
                          std::clamp(static_cast<int>(p.y()) / cell_px, 0, rows - 1));
    return static_cast<double>(cells.size()) / (kCells * rows);
}

bool CameraCalibrator::enough() const {
    constexpr double kEnoughCoverage = 0.8;
    return views() >= kEnoughViews && coverage() >= kEnoughCoverage;
}

Result<CalibrationResult> CameraCalibrator::Solve(double depth_units_per_m) const {
    if (views() < kLeastViews)
        return Status::Error(fmt::format(
            "the board was seen in {} different views; at least {} are needed: show it near and "
            "far, tilted, and in all corners of the image",
            views(), kLeastViews));
    Poses poses;
    for (std::size_t i = 0; i < views_.size(); ++i) poses.used.push_back(i);
    CalibrationResult result;
    result.rms_px = poses.Solve(*this);
    if (poses.DropOutliers()) result.rms_px = poses.Solve(*this);
    const auto number = [](const cv::Mat& m, int i) { return m.at<double>(i); };
    const cv::Mat& k = poses.camera;
    result.calibration.pinhole = {width_,
                                  height_,
                                  k.at<double>(0, 0),
                                  k.at<double>(1, 1),
                                  k.at<double>(0, 2),
                                  k.at<double>(1, 2)};
    const cv::Mat& d = poses.distortion;
    result.calibration.distortion = {number(d, 0), number(d, 1), number(d, 2), number(d, 3),
                                     number(d, 4)};
    if (poses.sigmas.total() >= kUnknowns) {
        result.fx_sigma_px = number(poses.sigmas, 0);
        result.fy_sigma_px = number(poses.sigmas, 1);
        result.cx_sigma_px = number(poses.sigmas, 2);
        result.cy_sigma_px = number(poses.sigmas, 3);
    }
    result.views = static_cast<int>(poses.used.size());
    result.calibration.depth_scale = depth_units_per_m;
    FindDepthFactor(poses, result);
    if (result.depth_factor)
        result.calibration.depth_scale = depth_units_per_m / *result.depth_factor;
    return result;
}

// Where a pixel's ray meets the board's plane is its true depth. Each view counts once.
void CameraCalibrator::FindDepthFactor(const Poses& poses, CalibrationResult& result) const {
    constexpr std::size_t kLeastInView = 50;
    std::vector<double> factors;
    for (std::size_t i = 0; i < poses.used.size(); ++i) {
        const std::vector<DepthSample>& samples = views_[poses.used[i]].depth;
        if (samples.size() < kLeastInView) continue;
        cv::Mat rotation;
        cv::Rodrigues(poses.rotations[i], rotation);
        const cv::Mat& t = poses.translations[i];
        const Eigen::Vector3d normal(rotation.at<double>(0, 2), rotation.at<double>(1, 2),
                                     rotation.at<double>(2, 2));
        const double distance =
            normal.dot(Eigen::Vector3d(t.at<double>(0), t.at<double>(1), t.at<double>(2)));
        std::vector<cv::Point2f> pixels, rays;
        for (const DepthSample& sample : samples) pixels.push_back(ToCv(sample.pixel));
        cv::undistortPoints(pixels, rays, poses.camera, poses.distortion);
        std::vector<double> ratios;
        for (std::size_t s = 0; s < samples.size(); ++s)
            ratios.push_back(distance / normal.dot(Eigen::Vector3d(rays[s].x, rays[s].y, 1)) /
                             samples[s].z_m);
        factors.push_back(Median(ratios));
    }
    if (factors.size() < kLeastViews) return;
    result.depth_factor = Median(factors);
    std::vector<double> deviations;
    for (const double factor : factors)
        deviations.push_back(std::abs(factor - *result.depth_factor));
    constexpr double kSigmaOfMad = 1.4826, kMedianLoss = 1.2533;
    const double of_mean = kSigmaOfMad * kMedianLoss * Median(deviations) /
                           std::sqrt(static_cast<double>(factors.size()));
    // A focal length that is 1 % too long puts the board 1 % too far away.
    result.depth_factor_sigma =
        std::hypot(of_mean, result.fx_sigma_px / result.calibration.pinhole.fx);
}

}  // namespace tessera
