// A small writer of SVG: shapes in metres on paper in millimetres. Owner thread only.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "plan/plan_geometry.h"

namespace tessera {

class SvgCanvas {
  public:
    // The drawing has `bounds` (metres, y up) at 1 : scale, with margins in millimetres of paper
    // around it and below.
    SvgCanvas(const Eigen::AlignedBox2d& bounds, double scale, double margin_mm, double below_mm);

    // `style`: attributes, as in fill="none".
    void Polygons(const std::vector<Polygon2d>& polygons, const std::string& style);
    void Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& style);
    void Lines(const std::vector<Polygon2d>& lines, const std::string& style);  // open
    // Centred at a place, `size_mm` high on paper, turned to run along `along`, never upside down.
    void Text(const Eigen::Vector2d& at, double size_mm, const std::string& text,
              const std::string& style = "",
              const Eigen::Vector2d& along = Eigen::Vector2d::UnitX());
    // The same without a turn, at millimetres from the paper's upper left corner; not centred.
    void Caption(double x_mm, double y_mm, double size_mm, const std::string& text,
                 const std::string& style = "");
    // An element as it is, in millimetres of paper.
    void Raw(const std::string& element) { body_ += element + "\n"; }

    Eigen::Vector2d Paper(const Eigen::Vector2d& p) const;
    double scale() const { return scale_; }
    double width_mm() const { return width_mm_; }
    double height_mm() const { return height_mm_; }
    std::string Finish(const std::string& title) const;

  private:
    std::string Path(const std::vector<Polygon2d>& lines, bool closed) const;

    Eigen::AlignedBox2d bounds_;
    double scale_, margin_mm_, width_mm_, height_mm_;
    std::string body_;
};

}  // namespace tessera
