#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "eval/alignment.h"
#include "eval/chart.h"
#include "eval/drift.h"
#include "eval/mesh_error.h"

namespace tessera {
namespace {

constexpr int kPlotWidth = 1280, kPlotHeight = 960;
constexpr Rgb8 kTracked{150, 154, 160}, kCorrectionCurve{31, 111, 214};

struct Corrected {
    double stamp_s = 0;
    Eigen::Vector3d tracked, estimate;  // in the reference's world
    double by_m() const { return (estimate - tracked).norm(); }
};

Chart::Range RangeAlong(const std::vector<Corrected>& path, int axis) {
    Chart::Range range{path[0].tracked(axis), path[0].tracked(axis)};
    for (const Corrected& pose : path) {
        range.low = std::min({range.low, pose.tracked(axis), pose.estimate(axis)});
        range.high = std::max({range.high, pose.tracked(axis), pose.estimate(axis)});
    }
    const double margin = std::max(0.05 * range.size(), 0.005);
    return {range.low - margin, range.high + margin};
}

void DrawPaths(const std::vector<Corrected>& path, const std::string& title, int x_axis, int y_axis,
               double most_m, const ChartArea& area, cv::Mat& canvas) {
    constexpr const char* kLabels[] = {"x [m]", "y [m]", "z [m]"};
    Chart chart(canvas, area, RangeAlong(path, x_axis), RangeAlong(path, y_axis), true);
    chart.DrawFrame(title, kLabels[x_axis], kLabels[y_axis]);
    std::vector<Eigen::Vector2d> tracked;
    for (const Corrected& pose : path)
        tracked.emplace_back(pose.tracked(x_axis), pose.tracked(y_axis));
    chart.DrawCurve(tracked, kTracked, 1.5);
    for (std::size_t i = 1; i < path.size(); ++i)
        chart.DrawSegment({path[i - 1].estimate(x_axis), path[i - 1].estimate(y_axis)},
                          {path[i].estimate(x_axis), path[i].estimate(y_axis)},
                          ErrorColour(path[i].by_m(), most_m), 2.5);
}

}  // namespace

Result<ColourImage> PlotCorrection(const std::vector<StampedPose>& reference,
                                   const std::vector<StampedPose>& tracked,
                                   const std::vector<StampedPose>& estimate,
                                   const std::string& title) {
    const Result<Alignment> alignment = AlignTrajectories(reference, estimate);
    if (!alignment.ok()) return alignment.status();
    const Eigen::Isometry3d& T = alignment.value().T_reference_estimate;
    std::vector<Corrected> path;
    double most_m = 1e-3;
    for (const PosePair& pair : AssociateByTime(tracked, estimate)) {
        path.push_back({estimate[pair.estimate].stamp_s,
                        T * tracked[pair.reference].T_world_camera.translation(),
                        T * estimate[pair.estimate].T_world_camera.translation()});
        most_m = std::max(most_m, path.back().by_m());
    }
    if (path.empty())
        return Status::Error("the path as tracked has no pose at a time of the estimate");
    cv::Mat canvas(kPlotHeight * kChartOversampling, kPlotWidth * kChartOversampling, CV_8UC3,
                   cv::Scalar(255, 255, 255));
    DrawText(canvas, title, {24, 34}, 14, -1, kInk);
    DrawText(canvas,
             fmt::format("grey: as tracked; coloured: corrected, from blue (0) to red ({:.0f} mm "
                         "from where it was tracked)",
                         1000 * most_m),
             {24, 62}, 11, -1, kInk);
    DrawPaths(path, "top (x-y)", 0, 1, most_m, {10, 80, 620, 560}, canvas);
    DrawPaths(path, "side (x-z)", 0, 2, most_m, {645, 80, 620, 560}, canvas);
    const double begin_s = path.front().stamp_s,
                 end_s = std::max(path.back().stamp_s - begin_s, 1e-3);
    Chart chart(canvas, {10, 650, 1255, 300}, {0, end_s}, {0, 1080 * most_m}, false);
    chart.DrawFrame("correction", "time [s]", "[mm]");
    std::vector<Eigen::Vector2d> corrections;
    for (const Corrected& pose : path)
        corrections.emplace_back(pose.stamp_s - begin_s, 1000 * pose.by_m());
    chart.DrawCurve(corrections, kCorrectionCurve, 1.5);
    ColourImage image(kPlotWidth, kPlotHeight);
    cv::Mat target(kPlotHeight, kPlotWidth, CV_8UC3, image.data());
    cv::resize(canvas, target, target.size(), 0, 0, cv::INTER_AREA);
    return image;
}

}  // namespace tessera
