// The analytic bodies that built-in scenes are made of: intersection, surface coordinates and
// signed distance in closed form. Plain values and functions, thread-safe.
#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace tessera {

enum class ShapeKind { kBox, kSphere, kCylinder, kRectangle };

// A body in its own frame: centred at the origin; a cylinder's axis is z; a rectangle lies in z =
// 0, faces +z, has no thickness and is seen from both sides.
struct Shape {
    ShapeKind kind = ShapeKind::kBox;
    // Metres. Box: half edges. Sphere: (radius, radius, radius). Cylinder: (radius, radius, half
    // height). Rectangle: (half width, half height, 0). So always the half edges of the bounding
    // box.
    Eigen::Vector3d half_size_m = Eigen::Vector3d::Ones();
    Eigen::Isometry3d T_world_shape = Eigen::Isometry3d::Identity();
};

// A chart is a part of the surface with plane coordinates (u, v) in metres, u to the right and v
// down for who looks at it from outside with the shape's z (for horizontal faces: y) upwards.
//   box: 0..5 = -x, +x, -y, +y, -z, +z    sphere: 0 (longitude, latitude)
//   cylinder: 0 side, 1 bottom, 2 top      rectangle: 0
int ChartCount(ShapeKind kind);
Eigen::Vector2d ChartSize(const Shape& shape, int chart);
// The chart's point in the shape's frame and back; (0, 0) is the chart's top-left corner.
Eigen::Vector3d PointOnChart(const Shape& shape, int chart, const Eigen::Vector2d& uv_m);
Eigen::Vector2d ChartPoint(const Shape& shape, int chart, const Eigen::Vector3d& p_shape);
// Unit, outwards, in the shape's frame.
Eigen::Vector3d NormalOnChart(const Shape& shape, int chart, const Eigen::Vector3d& p_shape);

// The normal's scalar product with a vector in the shape's frame: what NormalOnChart gives, at less
// cost.
double AlongNormal(const Shape& shape, int chart, const Eigen::Vector3d& p_shape,
                   const Eigen::Vector3d& vector);

struct ShapeHit {
    double t;  // p = origin + t * direction
    int chart;
};

// The nearest hit with 0 < t < t_max of a ray in the shape's frame; the direction need not be of
// unit length. A ray that starts inside a body hits its surface from inside.
std::optional<ShapeHit> Intersect(const Shape& shape, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction, double t_max);

// Distance of a point in the shape's frame to the surface, negative inside; a rectangle has no
// inside.
double SignedDistance(const Shape& shape, const Eigen::Vector3d& p_shape);

}  // namespace tessera
