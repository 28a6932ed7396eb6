#include "report/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page_text.h"

namespace tessera {
namespace {

constexpr double kWidth = 560, kLeft = 56, kRight = 14, kTop = 26, kBottom = 44;
constexpr double kChartHeight = 240, kStripHeight = 96;

struct Plot {
    const ChartSpec& spec;
    double height;

    double Bottom() const { return height - kBottom; }
    double X(double x) const {
        const double range = std::max(1e-12, spec.x_high - spec.x_low);
        return kLeft + (kWidth - kLeft - kRight) * (x - spec.x_low) / range;
    }
    double Y(double y) const {
        const double share = y / std::max(1e-12, spec.y_high);
        return Bottom() - (Bottom() - kTop) * std::clamp(share, 0.0, 1.0);
    }
    // The page finds out by data-* which time a click means.
    std::string Head(const char* style) const {
        return fmt::format(
            "<svg class=\"chart {}\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\" "
            "data-left=\"{}\" data-right=\"{}\" data-low=\"{:.6f}\" data-high=\"{:.6f}\">\n",
            style, kWidth, height, EscapeHtml(spec.title), kLeft, kWidth - kRight, spec.x_low,
            spec.x_high);
    }
    std::string XAxis() const {
        std::string svg;
        for (const double x : RoundTicks(spec.x_low, spec.x_high, 8))
            svg += fmt::format(
                "<line class=\"tick\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>"
                "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4:g}</text>\n",
                X(x), Bottom(), Bottom() + 4, Bottom() + 18, x);
        return svg + fmt::format(
                         "<line class=\"axis\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
                         "<text class=\"unit\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>"
                         "\n",
                         kLeft, kWidth - kRight, Bottom(), Bottom(), kWidth - kRight, height - 8,
                         EscapeHtml(spec.x_label));
    }
    std::string Cursor() const {
        return fmt::format(
            "<line class=\"cursor\" x1=\"0\" x2=\"0\" y1=\"{}\" y2=\"{:.1f}\"/>\n</svg>\n", kTop,
            Bottom());
    }
};

std::string YAxis(const Plot& plot) {
    std::string svg;
    for (const double y : RoundTicks(0, plot.spec.y_high, 6))
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
            "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
            kLeft, kWidth - kRight, plot.Y(y), kLeft - 8, plot.Y(y) + 4, y);
    return svg + fmt::format("<text class=\"unit\" x=\"0\" y=\"13\">{}</text>\n",
                             EscapeHtml(plot.spec.y_label));
}

std::string Legend(const ChartSpec& spec) {
    if (spec.series.size() < 2) return {};
    std::string html = "<p class=\"legend\">";
    for (const ChartSeries& series : spec.series)
        html += fmt::format("<span><i class=\"{}\"></i>{}</span>", EscapeHtml(series.style),
                            EscapeHtml(series.name));
    return html + "</p>\n";
}

}  // namespace

std::vector<double> RoundTicks(double low, double high, int most) {
    if (!(high > low) || most < 2) return {};
    const double least = (high - low) / (most - 1);
    const double power = std::pow(10, std::floor(std::log10(least)));
    double step = 10 * power;
    for (const double factor : {5.0, 2.0, 1.0})
        if (factor * power >= least * (1 - 1e-9)) step = factor * power;
    std::vector<double> ticks;
    // Not a running sum, which would end in 0.30000000000000004.
    for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
        ticks.push_back(i == 0 ? 0.0 : i * step);
    return ticks;
}

std::vector<Eigen::Vector2d> ThinnedCurve(const std::vector<Eigen::Vector2d>& points, double low,
                                          double high, int columns) {
    if (points.size() <= 2 * static_cast<std::size_t>(columns) || !(high > low)) return points;
    const auto column = [&](const Eigen::Vector2d& p) {
        return std::clamp(std::floor((p.x() - low) / (high - low) * columns), 0.0, columns - 1.0);
    };
    std::vector<Eigen::Vector2d> thinned;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        std::size_t lowest = begin, highest = begin;
        for (end = begin; end < points.size() && column(points[end]) == column(points[begin]);
             ++end) {
            if (points[end].y() < points[lowest].y()) lowest = end;
            if (points[end].y() > points[highest].y()) highest = end;
        }
        thinned.push_back(points[std::min(lowest, highest)]);
        if (lowest != highest) thinned.push_back(points[std::max(lowest, highest)]);
    }
    return thinned;
}

std::string ChartSvg(const ChartSpec& spec) {
    const Plot plot{spec, kChartHeight};
    std::string svg = plot.Head("curves") + YAxis(plot) + plot.XAxis();
    for (const ChartSeries& series : spec.series) {
        svg += fmt::format("<polyline class=\"curve {}\" points=\"", EscapeHtml(series.style));
        for (const Eigen::Vector2d& p : ThinnedCurve(series.points, spec.x_low, spec.x_high, 480))
            svg += fmt::format("{:.1f},{:.1f} ", plot.X(p.x()), plot.Y(p.y()));
        svg += "\"/>\n";
    }
    return svg + plot.Cursor() + Legend(spec);
}

std::string StripSvg(const ChartSpec& axis, const std::vector<StripPiece>& pieces) {
    const Plot plot{axis, kStripHeight};
    std::string svg = plot.Head("strip");
    for (const StripPiece& piece : pieces)
        svg += fmt::format(
            "<rect class=\"{}\" x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"{:.1f}\"/>\n",
            EscapeHtml(piece.style), plot.X(piece.begin), kTop,
            std::max(1.0, plot.X(piece.end) - plot.X(piece.begin)), plot.Bottom() - kTop);
    return svg + plot.XAxis() + plot.Cursor();
}

}  // namespace tessera
