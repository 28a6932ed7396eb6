// A small writer of DXF R12 (AC1009), the ASCII format that every CAD program reads. [AutoCAD
// Release 12 Customization Manual, chapter 11.] Owner thread only.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "plan/plan_geometry.h"

namespace tessera {

class DxfDrawing {
  public:
    // Layers by name and AutoCAD colour number. `comment`: one line at the beginning of the file.
    DxfDrawing(const std::vector<std::pair<std::string, int>>& layers, const std::string& comment);

    void Line(const std::string& layer, const Eigen::Vector2d& from, const Eigen::Vector2d& to);
    // No entity if fewer than two points.
    void Polyline(const std::string& layer, const Polygon2d& points, bool closed);
    // Centred at `at`. Control characters become spaces, what ASCII lacks becomes \U+XXXX.
    void Text(const std::string& layer, const Eigen::Vector2d& at, double height,
              const std::string& text, double angle_rad);
    // The whole file.
    std::string Finish() const;

  private:
    void Entity(const char* type, const std::string& layer);
    void Point(const Eigen::Vector2d& p, int code = 10);

    std::string head_, entities_;
    Eigen::Vector2d low_{0, 0}, high_{0, 0};  // of everything drawn
    bool empty_ = true;
};

}  // namespace tessera
