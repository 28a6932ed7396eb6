#include "eval/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/check.h"
#include "eval/chart.h"
#include "eval/mesh_error.h"

namespace tessera {
namespace {

constexpr int kWidth = 1280, kHeight = 960;
constexpr Rgb8 kReference{60, 64, 70}, kEstimate{31, 111, 214}, kError{232, 140, 120};
constexpr Rgb8 kRmse{190, 60, 40};

ColourImage ScaledDown(const cv::Mat& canvas, int width, int height) {
    ColourImage image(width, height);
    cv::Mat target(height, width, CV_8UC3, image.data());
    cv::resize(canvas, target, target.size(), 0, 0, cv::INTER_AREA);
    return image;
}

// The range of both paths along an axis, with a margin, never empty.
Chart::Range RangeOf(const AteResult& result, int axis) {
    Chart::Range range{result.pairs[0].p_reference(axis), result.pairs[0].p_reference(axis)};
    for (const AteResult::Pair& pair : result.pairs) {
        range.low = std::min({range.low, pair.p_reference(axis), pair.p_estimate(axis)});
        range.high = std::max({range.high, pair.p_reference(axis), pair.p_estimate(axis)});
    }
    const double margin = std::max(0.05 * range.size(), 0.005);
    return {range.low - margin, range.high + margin};
}

void DrawView(const AteResult& result, const std::string& title, int x_axis, int y_axis,
              const ChartArea& area, cv::Mat& canvas) {
    constexpr const char* kLabels[] = {"x [m]", "y [m]", "z [m]"};
    Chart chart(canvas, area, RangeOf(result, x_axis), RangeOf(result, y_axis), true);
    chart.DrawFrame(title, kLabels[x_axis], kLabels[y_axis]);
    std::vector<Eigen::Vector2d> reference, estimate;
    for (const AteResult::Pair& pair : result.pairs) {
        reference.emplace_back(pair.p_reference(x_axis), pair.p_reference(y_axis));
        estimate.emplace_back(pair.p_estimate(x_axis), pair.p_estimate(y_axis));
        chart.DrawSegment(reference.back(), estimate.back(), kError, 1);
    }
    chart.DrawCurve(reference, kReference, 1.5);
    chart.DrawCurve(estimate, kEstimate, 1.5);
}

void DrawErrors(const AteResult& result, const ChartArea& area, cv::Mat& canvas) {
    const double begin_s = result.pairs.front().stamp_s;
    const double end_s = std::max(result.pairs.back().stamp_s - begin_s, 1e-3);
    const double top_mm = std::max(1000 * result.error_m.max * 1.08, 1e-3);
    Chart chart(canvas, area, {0, end_s}, {0, top_mm}, false);
    chart.DrawFrame("error over time", "time since first pair [s]", "error [mm]");
    std::vector<Eigen::Vector2d> errors;
    for (const AteResult::Pair& pair : result.pairs)
        errors.emplace_back(pair.stamp_s - begin_s, 1000 * pair.error_m);
    chart.DrawCurve(errors, kEstimate, 1.5);
    const double rmse_mm = 1000 * result.error_m.rmse;
    for (int i = 0; i < 60; ++i)  // dashed
        chart.DrawSegment({i * end_s / 60, rmse_mm}, {(i + 0.5) * end_s / 60, rmse_mm}, kRmse, 1.5);
}

void DrawLegend(cv::Mat& canvas, double y) {
    double x = 640;
    const std::pair<const char*, Rgb8> entries[] = {{"reference", kReference},
                                                    {"estimate, aligned", kEstimate},
                                                    {"error", kError},
                                                    {"RMSE", kRmse}};
    for (const auto& [name, colour] : entries) {
        const cv::Point a(static_cast<int>(x) * kChartOversampling,
                          static_cast<int>(y - 5) * kChartOversampling);
        cv::rectangle(canvas, {a.x, a.y - 3, 26 * kChartOversampling, 7},
                      {double(colour.r), double(colour.g), double(colour.b)}, cv::FILLED);
        DrawText(canvas, name, {x + 34, y}, 10, -1, kInk);
        x += 64 + 9.5 * static_cast<double>(std::string_view(name).size());
    }
}

}  // namespace

ColourImage PlotAte(const AteResult& result, const std::string& title) {
    TESSERA_CHECK(!result.pairs.empty(), "nothing to plot");
    const ErrorStatistics& e = result.error_m;
    cv::Mat canvas(kHeight * kChartOversampling, kWidth * kChartOversampling, CV_8UC3,
                   cv::Scalar(255, 255, 255));
    DrawText(canvas, title, {24, 34}, 14, -1, kInk);
    DrawText(canvas,
             fmt::format("ATE RMSE {:.2f} mm    mean {:.2f} mm    median {:.2f} mm    max {:.2f} mm"
                         "    {} pairs, SE(3) alignment",
                         1000 * e.rmse, 1000 * e.mean, 1000 * e.median, 1000 * e.max,
                         result.pairs.size()),
             {24, 62}, 11, -1, kInk);
    DrawLegend(canvas, 34);
    DrawView(result, "top (x-y)", 0, 1, {10, 80, 620, 430}, canvas);
    DrawView(result, "side (x-z)", 0, 2, {645, 80, 620, 430}, canvas);
    DrawView(result, "side (y-z)", 1, 2, {10, 520, 620, 430}, canvas);
    DrawErrors(result, {645, 520, 620, 430}, canvas);
    return ScaledDown(canvas, kWidth, kHeight);
}

void DrawErrorScale(double max_m, ColourImage& image) {
    TESSERA_CHECK(max_m > 0, "max {} m", max_m);
    const cv::Mat picture(image.height(), image.width(), CV_8UC3, image.data());
    cv::Mat canvas;
    cv::resize(picture, canvas, {}, kChartOversampling, kChartOversampling, cv::INTER_NEAREST);
    const int left = 24, width = std::max(60, image.width() / 4), height = 14;
    const int top = image.height() - 52;
    const cv::Rect box(left - 14, top - 30, width + 68, height + 66);
    cv::rectangle(canvas, {box.tl() * kChartOversampling, box.br() * kChartOversampling},
                  {255, 255, 255}, cv::FILLED);
    for (int i = 0; i < width * kChartOversampling; ++i) {
        const Rgb8 c = ErrorColour(i + 0.5, width * kChartOversampling);
        cv::rectangle(canvas,
                      {left * kChartOversampling + i, top * kChartOversampling, 1,
                       height * kChartOversampling},
                      {double(c.r), double(c.g), double(c.b)}, cv::FILLED);
    }
    DrawText(canvas, "0", {double(left), top + height + 18.0}, 10, 0, kInk);
    DrawText(canvas, fmt::format("{:.3g} mm", 1000 * max_m),
             {double(left + width), top + height + 18.0}, 10, 0, kInk);
    DrawText(canvas, "distance to the reference", {double(left), top - 8.0}, 10, -1, kInk);
    image = ScaledDown(canvas, image.width(), image.height());
}

}  // namespace tessera
