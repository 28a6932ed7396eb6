#include "plan/svg_canvas.h"

#include <fmt/format.h>

#include <numbers>

#include "report/page_text.h"

namespace tessera {

SvgCanvas::SvgCanvas(const Eigen::AlignedBox2d& bounds, double scale, double margin_mm,
                     double below_mm)
    : bounds_(bounds),
      scale_(scale),
      margin_mm_(margin_mm),
      width_mm_(1000 * bounds.sizes().x() / scale + 2 * margin_mm),
      height_mm_(1000 * bounds.sizes().y() / scale + 2 * margin_mm + below_mm) {}

Eigen::Vector2d SvgCanvas::Paper(const Eigen::Vector2d& p) const {
    return {margin_mm_ + 1000 * (p.x() - bounds_.min().x()) / scale_,
            margin_mm_ + 1000 * (bounds_.max().y() - p.y()) / scale_};
}

std::string SvgCanvas::Path(const std::vector<Polygon2d>& lines, bool closed) const {
    std::string path;
    for (const Polygon2d& line : lines) {
        for (std::size_t i = 0; i < line.size(); ++i) {
            const Eigen::Vector2d p = Paper(line[i]);
            path += fmt::format("{}{:.2f} {:.2f}", i == 0 ? "M" : "L", p.x(), p.y());
        }
        if (closed && !line.empty()) path += "Z";
    }
    return path;
}

void SvgCanvas::Polygons(const std::vector<Polygon2d>& polygons, const std::string& style) {
    if (polygons.empty()) return;
    Raw(fmt::format(R"(<path d="{}" {}/>)", Path(polygons, true), style));
}

void SvgCanvas::Lines(const std::vector<Polygon2d>& lines, const std::string& style) {
    if (lines.empty()) return;
    Raw(fmt::format(R"(<path fill="none" d="{}" {}/>)", Path(lines, false), style));
}

void SvgCanvas::Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                     const std::string& style) {
    Lines({{from, to}}, style);
}

void SvgCanvas::Text(const Eigen::Vector2d& at, double size_mm, const std::string& text,
                     const std::string& style, const Eigen::Vector2d& along) {
    double degrees = -std::atan2(along.y(), along.x()) * 180 / std::numbers::pi;
    if (degrees > 90 - 1e-6) degrees -= 180;
    if (degrees <= -90 - 1e-6) degrees += 180;
    const Eigen::Vector2d p = Paper(at);
    Raw(fmt::format(
        R"(<text text-anchor="middle" font-size="{:.2f}" transform="translate({:.2f} {:.2f}) )"
        R"svg(rotate({:.2f})" y="{:.2f}" {}>{}</text>)svg",
        size_mm, p.x(), p.y(), degrees, 0.35 * size_mm, style, EscapeHtml(text)));
}

void SvgCanvas::Caption(double x_mm, double y_mm, double size_mm, const std::string& text,
                        const std::string& style) {
    Raw(fmt::format(R"(<text x="{:.2f}" y="{:.2f}" font-size="{:.2f}" {}>{}</text>)", x_mm, y_mm,
                    size_mm, style, EscapeHtml(text)));
}

std::string SvgCanvas::Finish(const std::string& title) const {
    return fmt::format(
        R"(<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="{0:.2f}mm" height="{1:.2f}mm" viewBox="0 0 {0:.2f} {1:.2f}"
     font-family="'DejaVu Sans', Helvetica, Arial, sans-serif" fill="#222">
<title>{2}</title>
<rect width="100%" height="100%" fill="#fff"/>
{3}</svg>
)",
        width_mm_, height_mm_, EscapeHtml(title), body_);
}

}  // namespace tessera
