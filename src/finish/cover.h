// The cells of a grid whose centres a triangle covers.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tessera {

// Thinner triangles cover nothing: their weights would be rounding errors. In cells.
inline constexpr float kThinnest = 0.02f;

// The weights of the corners at the point of the triangle's outline that is nearest to p.
inline Eigen::Vector3f NearestOnOutline(const std::array<Eigen::Vector2f, 3>& corners,
                                        const Eigen::Vector2f& p) {
    Eigen::Vector3f nearest = Eigen::Vector3f::Zero();
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const Eigen::Vector2f side = corners[next] - corners[k];
        const float along = std::clamp((p - corners[k]).dot(side) / side.squaredNorm(), 0.0f, 1.0f);
        const float distance = (corners[k] + along * side - p).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        nearest.setZero();
        nearest[static_cast<Eigen::Index>(k)] = 1 - along;
        nearest[static_cast<Eigen::Index>(next)] = along;
    }
    return nearest;
}

// Calls take(x, y, weights) for each integer point (x, y) that is at most `margin` outside the
// triangle (if negative: at least so far inside), measured across its edges. weights: of the
// corners, sum 1, at the point or, if it is outside, at the nearest point of the triangle.
template <class Take>
void ForEachCovered(const std::array<Eigen::Vector2f, 3>& corners, float margin, const Take& take) {
    const Eigen::Vector2f &a = corners[0], &b = corners[1], &c = corners[2];
    const auto cross = [](const Eigen::Vector2f& u, const Eigen::Vector2f& v) {
        return u.x() * v.y() - u.y() * v.x();
    };
    const float area = cross(b - a, c - a);
    // A point's weight times `height` is its distance from the edge.
    const Eigen::Array3f height =
        std::abs(area) / Eigen::Array3f((c - b).norm(), (a - c).norm(), (b - a).norm());
    if (!(height.minCoeff() > kThinnest)) return;
    const Eigen::Array2f low = a.cwiseMin(b).cwiseMin(c).array() - margin,
                         high = a.cwiseMax(b).cwiseMax(c).array() + margin;
    for (int y = static_cast<int>(std::ceil(low.y())); y <= static_cast<int>(high.y()); ++y)
        for (int x = static_cast<int>(std::ceil(low.x())); x <= static_cast<int>(high.x()); ++x) {
            const Eigen::Vector2f p(static_cast<float>(x), static_cast<float>(y));
            Eigen::Array3f weights(cross(b - p, c - p), cross(c - p, a - p), cross(a - p, b - p));
            weights /= area;
            if ((weights * height).minCoeff() < -margin) continue;
            take(x, y,
                 weights.minCoeff() >= 0 ? Eigen::Vector3f(weights) : NearestOnOutline(corners, p));
        }
}

}  // namespace tessera
