#include "synth/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace tessera {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

// Axes along u (right) and v (down) of the six box faces, as sign * (axis index + 1).
struct FaceAxes {
    int u, v;
};
constexpr FaceAxes kBoxFaces[6] = {{-2, -3}, {2, -3}, {1, -3}, {-1, -3}, {1, 2}, {1, -2}};

double AlongAxis(const Vector3d& p, const Vector3d& half, int axis) {
    const int i = std::abs(axis) - 1;
    return half[i] + (axis > 0 ? p[i] : -p[i]);
}

void SetAlongAxis(Vector3d& p, const Vector3d& half, int axis, double value) {
    const int i = std::abs(axis) - 1;
    p[i] = axis > 0 ? value - half[i] : half[i] - value;
}

std::optional<ShapeHit> IntersectBox(const Vector3d& half, const Vector3d& o, const Vector3d& d,
                                     double t_max) {
    double t_in = -std::numeric_limits<double>::infinity(), t_out = -t_in;
    int chart_in = 0, chart_out = 0;
    for (int i = 0; i < 3; ++i) {
        // Avoids 0 * infinity for a ray parallel to the slab.
        const double inverse = 1.0 / (std::abs(d[i]) < 1e-300 ? std::copysign(1e-300, d[i]) : d[i]);
        const double a = (-half[i] - o[i]) * inverse, b = (half[i] - o[i]) * inverse;
        const double low = std::min(a, b), high = std::max(a, b);
        const bool forward = inverse > 0;
        if (low > t_in) t_in = low, chart_in = 2 * i + (forward ? 0 : 1);
        if (high < t_out) t_out = high, chart_out = 2 * i + (forward ? 1 : 0);
        if (t_in > t_out || t_in >= t_max || t_out <= 0) return std::nullopt;
    }
    if (t_in > 0) return ShapeHit{t_in, chart_in};
    if (t_out < t_max) return ShapeHit{t_out, chart_out};
    return std::nullopt;
}

// Roots of |o + t d| = radius in the first `dimensions` coordinates, ascending. Computed from the
// closest point, so that distant origins do not lose precision.
template <int dimensions>
std::optional<std::pair<double, double>> CircleRoots(const Vector3d& o, const Vector3d& d,
                                                     double radius) {
    const auto oc = o.head<dimensions>(), dc = d.head<dimensions>();
    const double a = dc.squaredNorm();
    if (a < 1e-300) return std::nullopt;
    const double t_closest = -oc.dot(dc) / a;
    const double distance2 = (oc + t_closest * dc).squaredNorm();
    const double rest = radius * radius - distance2;
    if (rest < 0) return std::nullopt;
    const double half_chord = std::sqrt(rest / a);
    return std::make_pair(t_closest - half_chord, t_closest + half_chord);
}

std::optional<ShapeHit> IntersectSphere(double radius, const Vector3d& o, const Vector3d& d,
                                        double t_max) {
    const auto roots = CircleRoots<3>(o, d, radius);
    if (!roots) return std::nullopt;
    const double t = roots->first > 0 ? roots->first : roots->second;
    if (t > 0 && t < t_max) return ShapeHit{t, 0};
    return std::nullopt;
}

std::optional<ShapeHit> IntersectCylinder(const Vector3d& half, const Vector3d& o,
                                          const Vector3d& d, double t_max) {
    ShapeHit best{t_max, -1};
    const auto consider = [&best](double t, int chart) {
        if (t > 0 && t < best.t) best = {t, chart};
    };
    if (const auto roots = CircleRoots<2>(o, d, half.x())) {
        for (const double t : {roots->first, roots->second})
            if (std::abs(o.z() + t * d.z()) <= half.z()) consider(t, 0);
    }
    if (d.z() != 0) {
        for (const int side : {-1, 1}) {
            const double t = (side * half.z() - o.z()) / d.z();
            const Vector2d p = o.head<2>() + t * d.head<2>();
            if (p.squaredNorm() <= half.x() * half.x()) consider(t, side < 0 ? 1 : 2);
        }
    }
    if (best.chart < 0) return std::nullopt;
    return best;
}

std::optional<ShapeHit> IntersectRectangle(const Vector3d& half, const Vector3d& o,
                                           const Vector3d& d, double t_max) {
    if (d.z() == 0) return std::nullopt;
    const double t = -o.z() / d.z();
    if (!(t > 0 && t < t_max)) return std::nullopt;
    if (std::abs(o.x() + t * d.x()) > half.x() || std::abs(o.y() + t * d.y()) > half.y())
        return std::nullopt;
    return ShapeHit{t, 0};
}

// Outside: norm of the positive part. Inside: the largest (negative) component.
template <class Vector>
double BoxDistance(const Vector& q) {
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

}  // namespace

int ChartCount(ShapeKind kind) {
    switch (kind) {
        case ShapeKind::kBox: return 6;
        case ShapeKind::kCylinder: return 3;
        default: return 1;
    }
}

Vector2d ChartSize(const Shape& shape, int chart) {
    const Vector3d edge = 2.0 * shape.half_size_m;
    switch (shape.kind) {
        case ShapeKind::kBox: {
            const FaceAxes axes = kBoxFaces[chart];
            return {edge[std::abs(axes.u) - 1], edge[std::abs(axes.v) - 1]};
        }
        case ShapeKind::kSphere: return {kPi * edge.x(), kPi * edge.x() / 2};
        case ShapeKind::kCylinder:
            return chart == 0 ? Vector2d(kPi * edge.x(), edge.z()) : Vector2d(edge.x(), edge.x());
        case ShapeKind::kRectangle: break;
    }
    return edge.head<2>();
}

Vector3d PointOnChart(const Shape& shape, int chart, const Vector2d& uv) {
    const Vector3d& half = shape.half_size_m;
    switch (shape.kind) {
        case ShapeKind::kBox: {
            Vector3d p;
            p[chart / 2] = chart % 2 == 0 ? -half[chart / 2] : half[chart / 2];
            SetAlongAxis(p, half, kBoxFaces[chart].u, uv.x());
            SetAlongAxis(p, half, kBoxFaces[chart].v, uv.y());
            return p;
        }
        case ShapeKind::kSphere: {
            const double longitude = uv.x() / half.x() - kPi,
                         latitude = kPi / 2 - uv.y() / half.x();
            return half.x() * Vector3d(std::cos(latitude) * std::cos(longitude),
                                       std::cos(latitude) * std::sin(longitude),
                                       std::sin(latitude));
        }
        case ShapeKind::kCylinder: {
            if (chart != 0)
                return {uv.x() - half.x(), chart == 1 ? uv.y() - half.x() : half.x() - uv.y(),
                        chart == 1 ? -half.z() : half.z()};
            const double angle = uv.x() / half.x() - kPi;
            return {half.x() * std::cos(angle), half.x() * std::sin(angle), half.z() - uv.y()};
        }
        case ShapeKind::kRectangle: break;
    }
    return {uv.x() - half.x(), half.y() - uv.y(), 0.0};
}

Vector2d ChartPoint(const Shape& shape, int chart, const Vector3d& p) {
    const Vector3d& half = shape.half_size_m;
    switch (shape.kind) {
        case ShapeKind::kBox:
            return {AlongAxis(p, half, kBoxFaces[chart].u), AlongAxis(p, half, kBoxFaces[chart].v)};
        case ShapeKind::kSphere:
            return half.x() *
                   Vector2d(std::atan2(p.y(), p.x()) + kPi,
                            kPi / 2 - std::asin(std::clamp(p.z() / half.x(), -1.0, 1.0)));
        case ShapeKind::kCylinder:
            if (chart != 0)
                return {p.x() + half.x(), chart == 1 ? p.y() + half.x() : half.x() - p.y()};
            return {half.x() * (std::atan2(p.y(), p.x()) + kPi), half.z() - p.z()};
        case ShapeKind::kRectangle: break;
    }
    return {p.x() + half.x(), half.y() - p.y()};
}

Vector3d NormalOnChart(const Shape& shape, int chart, const Vector3d& p) {
    switch (shape.kind) {
        case ShapeKind::kBox: return (chart % 2 == 0 ? -1.0 : 1.0) * Vector3d::Unit(chart / 2);
        case ShapeKind::kSphere: return p.normalized();
        case ShapeKind::kCylinder:
            if (chart == 0) return Vector3d(p.x(), p.y(), 0).normalized();
            return chart == 1 ? Vector3d(0, 0, -1) : Vector3d(0, 0, 1);
        case ShapeKind::kRectangle: break;
    }
    return Vector3d::UnitZ();
}

double AlongNormal(const Shape& shape, int chart, const Vector3d& p, const Vector3d& vector) {
    switch (shape.kind) {
        case ShapeKind::kBox: return chart % 2 == 0 ? -vector[chart / 2] : vector[chart / 2];
        case ShapeKind::kSphere: return p.dot(vector) / shape.half_size_m.x();
        case ShapeKind::kCylinder:
            if (chart == 0) return p.head<2>().dot(vector.head<2>()) / shape.half_size_m.x();
            return chart == 1 ? -vector.z() : vector.z();
        case ShapeKind::kRectangle: break;
    }
    return vector.z();
}

std::optional<ShapeHit> Intersect(const Shape& shape, const Vector3d& origin,
                                  const Vector3d& direction, double t_max) {
    switch (shape.kind) {
        case ShapeKind::kBox: return IntersectBox(shape.half_size_m, origin, direction, t_max);
        case ShapeKind::kSphere:
            return IntersectSphere(shape.half_size_m.x(), origin, direction, t_max);
        case ShapeKind::kCylinder:
            return IntersectCylinder(shape.half_size_m, origin, direction, t_max);
        case ShapeKind::kRectangle: break;
    }
    return IntersectRectangle(shape.half_size_m, origin, direction, t_max);
}

double SignedDistance(const Shape& shape, const Vector3d& p) {
    const Vector3d& half = shape.half_size_m;
    switch (shape.kind) {
        case ShapeKind::kBox: return BoxDistance(Vector3d(p.cwiseAbs() - half));
        case ShapeKind::kSphere: return p.norm() - half.x();
        case ShapeKind::kCylinder:
            return BoxDistance(Vector2d(p.head<2>().norm() - half.x(), std::abs(p.z()) - half.z()));
        case ShapeKind::kRectangle: break;
    }
    return Vector3d(p.cwiseAbs() - half).cwiseMax(0.0).norm();
}

}  // namespace tessera
