// The point of a triangle nearest to another point. Exact in double, also for degenerate triangles.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

namespace tessera {

// The point of segment a-b nearest to p. a may equal b.
inline Eigen::Vector3d ClosestOnSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b) {
    const Eigen::Vector3d ab = b - a;
    const double length2 = ab.squaredNorm();
    const double u = length2 > 0 ? std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) : 0.0;
    return a + u * ab;
}

// The point of triangle a-b-c, including its interior, nearest to p. The triangle may degenerate to
// a segment or a point. Thread-safe.
inline Eigen::Vector3d ClosestOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                         const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const Eigen::Vector3d ab = b - a, ac = c - a, normal = ab.cross(ac);
    const double area2 = normal.squaredNorm();
    if (area2 > 1e-20 * ab.squaredNorm() * ac.squaredNorm()) {
        // Barycentric coordinates of the foot of the perpendicular.
        const Eigen::Vector3d ap = p - a;
        const double v = ap.cross(ac).dot(normal) / area2;
        const double w = ab.cross(ap).dot(normal) / area2;
        if (v >= 0 && w >= 0 && v + w <= 1) return a + v * ab + w * ac;
    }
    Eigen::Vector3d best = ClosestOnSegment(p, a, b);
    for (const Eigen::Vector3d& q : {ClosestOnSegment(p, b, c), ClosestOnSegment(p, c, a)})
        if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
    return best;
}

}  // namespace tessera
