#include "eval/chart.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace tessera {
namespace {

constexpr Rgb8 kGrid{228, 231, 235};
constexpr int kSubpixelBits = 4;

cv::Scalar ToScalar(const Rgb8& c) { return {double(c.r), double(c.g), double(c.b)}; }

void DrawLine(cv::Mat& canvas, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
              const Rgb8& colour, double width_px) {
    const auto fixed = [](const Eigen::Vector2d& p) {
        const double scale = kChartOversampling * (1 << kSubpixelBits);
        return cv::Point(static_cast<int>(std::lround(p.x() * scale)),
                         static_cast<int>(std::lround(p.y() * scale)));
    };
    const int thickness = std::max(1, static_cast<int>(std::lround(width_px * kChartOversampling)));
    cv::line(canvas, fixed(a), fixed(b), ToScalar(colour), thickness, cv::LINE_AA, kSubpixelBits);
}

// Tick step of 1, 2 or 5 times a power of ten that gives at most about `count` ticks.
double TickStep(double size, double count) {
    const double power = std::pow(10, std::floor(std::log10(size / count)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= size / count) return factor * power;
    return 10 * power;
}

std::string TickLabel(double value, double step) {
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    return fmt::format("{:.{}f}", std::abs(value) < step / 2 ? 0.0 : value, decimals);
}

// Calls use(value) for each tick in the range.
template <class Use>
void ForTicks(const Chart::Range& range, double step, const Use& use) {
    const auto last = static_cast<int>(std::floor(range.size() / step)) + 1;
    const double first = std::ceil(range.low / step) * step;
    for (int i = 0; i <= last; ++i)
        if (const double value = first + i * step; value <= range.high) use(value);
}

}  // namespace

void DrawText(cv::Mat& canvas, const std::string& text, const Eigen::Vector2d& at, double height_px,
              int align, const Rgb8& colour) {
    constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
    const double scale = height_px * kChartOversampling / 21.0;  // capitals are 21 high at scale 1
    const int thickness = std::max(1, static_cast<int>(std::lround(scale * 1.6)));
    const int width = cv::getTextSize(text, kFont, scale, thickness, nullptr).width;
    const cv::Point begin(static_cast<int>(at.x() * kChartOversampling) - width * (align + 1) / 2,
                          static_cast<int>(at.y() * kChartOversampling));
    cv::putText(canvas, text, begin, kFont, scale, ToScalar(colour), thickness, cv::LINE_AA);
}

Chart::Chart(cv::Mat& canvas, const ChartArea& area, Range x, Range y, bool equal_scale)
    : canvas_(canvas),
      area_(area),
      plot_{area.x + 62, area.y + 30, area.width - 80, area.height - 78},
      x_(x),
      y_(y) {
    const auto widen = [](Range& range, double size) {
        const double more = std::max(0.0, size - range.size()) / 2;
        range = {range.low - more, range.high + more};
    };
    if (!equal_scale) return;
    const double units_per_px = std::max(x_.size() / plot_.width, y_.size() / plot_.height);
    widen(x_, units_per_px * plot_.width);
    widen(y_, units_per_px * plot_.height);
}

Eigen::Vector2d Chart::ToPixel(const Eigen::Vector2d& p) const {
    return {plot_.x + (p.x() - x_.low) / x_.size() * plot_.width,
            plot_.y + (y_.high - p.y()) / y_.size() * plot_.height};
}

void Chart::DrawFrame(const std::string& title, const std::string& x_label,
                      const std::string& y_label) {
    const double x_step = TickStep(x_.size(), plot_.width / 80);
    const double y_step = TickStep(y_.size(), plot_.height / 50);
    const double bottom = plot_.y + plot_.height, right = plot_.x + plot_.width;
    ForTicks(x_, x_step, [&](double value) {
        const double x = ToPixel({value, y_.low}).x();
        DrawLine(canvas_, {x, plot_.y}, {x, bottom}, kGrid, 1);
        DrawText(canvas_, TickLabel(value, x_step), {x, bottom + 18}, 9, 0, kInk);
    });
    ForTicks(y_, y_step, [&](double value) {
        const double y = ToPixel({x_.low, value}).y();
        DrawLine(canvas_, {plot_.x, y}, {right, y}, kGrid, 1);
        DrawText(canvas_, TickLabel(value, y_step), {plot_.x - 8, y + 4}, 9, 1, kInk);
    });
    const Eigen::Vector2d corners[] = {
        {plot_.x, plot_.y}, {right, plot_.y}, {right, bottom}, {plot_.x, bottom}};
    for (int i = 0; i < 4; ++i) DrawLine(canvas_, corners[i], corners[(i + 1) % 4], kInk, 1);
    DrawText(canvas_, title, {plot_.x + plot_.width / 2, plot_.y - 10}, 10, 0, kInk);
    DrawText(canvas_, x_label, {plot_.x + plot_.width / 2, bottom + 38}, 10, 0, kInk);
    DrawText(canvas_, y_label, {area_.x + 4, plot_.y - 10}, 10, -1, kInk);
}

void Chart::DrawSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Rgb8& colour,
                        double width_px) {
    DrawLine(canvas_, ToPixel(p), ToPixel(q), colour, width_px);
}

void Chart::DrawCurve(const std::vector<Eigen::Vector2d>& points, const Rgb8& colour,
                      double width_px) {
    for (std::size_t i = 1; i < points.size(); ++i)
        DrawSegment(points[i - 1], points[i], colour, width_px);
}

}  // namespace tessera
