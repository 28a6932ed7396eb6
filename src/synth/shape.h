// Analytic bodies of the built-in scenes: closed-form intersection, surface coordinates and signed
// distance. Plain values and functions, thread-safe.
#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace tessera {

enum class ShapeKind { kBox, kSphere, kCylinder, kRectangle };

// A body in its own frame, centred at the origin. The axis of a cylinder is z. A rectangle lies in
// z = 0, faces +z, has no thickness and is visible from both sides.
struct Shape {
    ShapeKind kind = ShapeKind::kBox;
    // Half the edges of the bounding box, metres. Box: half edges. Sphere: (radius, radius,
    // radius). Cylinder: (radius, radius, half height). Rectangle: (half width, half height, 0).
    Eigen::Vector3d half_size_m = Eigen::Vector3d::Ones();
    Eigen::Isometry3d T_world_shape = Eigen::Isometry3d::Identity();
};

// A chart is a part of the surface with planar coordinates (u, v) in metres. Seen from outside with
// the shape's z axis up (y axis for horizontal faces), u points right and v points down.
//   box: 0..5 = -x, +x, -y, +y, -z, +z    sphere: 0 (longitude, latitude)
//   cylinder: 0 side, 1 bottom, 2 top      rectangle: 0
int ChartCount(ShapeKind kind);
Eigen::Vector2d ChartSize(const Shape& shape, int chart);
// Converts chart coordinates to a point in the shape's frame and back. (0, 0) is the top-left
// corner of the chart.
Eigen::Vector3d PointOnChart(const Shape& shape, int chart, const Eigen::Vector2d& uv_m);
Eigen::Vector2d ChartPoint(const Shape& shape, int chart, const Eigen::Vector3d& p_shape);
// Outward unit normal in the shape's frame.
Eigen::Vector3d NormalOnChart(const Shape& shape, int chart, const Eigen::Vector3d& p_shape);

// Dot product of the normal with a vector in the shape's frame; cheaper than NormalOnChart.
double AlongNormal(const Shape& shape, int chart, const Eigen::Vector3d& p_shape,
                   const Eigen::Vector3d& vector);

struct ShapeHit {
    double t;  // p = origin + t * direction
    int chart;
};

// Returns the nearest hit with 0 < t < t_max of a ray in the shape's frame. The direction need not
// have unit length. A ray that starts inside a body hits its surface from the inside.
std::optional<ShapeHit> Intersect(const Shape& shape, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction, double t_max);

// Distance from a point in the shape's frame to the surface, negative inside. A rectangle has no
// inside.
double SignedDistance(const Shape& shape, const Eigen::Vector3d& p_shape);

}  // namespace tessera
