// Lines, intervals and polygons of a floor plan. Metres, in the plane of the floor.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace tessera {

using Polygon2d = std::vector<Eigen::Vector2d>;

// All p with normal . p = offset_m. Positions along it are measured from the foot of the origin.
struct PlanLine {
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // unit
    double offset_m = 0;

    Eigen::Vector2d Direction() const { return {-normal.y(), normal.x()}; }
    double Distance(const Eigen::Vector2d& p) const { return normal.dot(p) - offset_m; }
    double Along(const Eigen::Vector2d& p) const { return Direction().dot(p); }
    Eigen::Vector2d At(double along_m) const { return offset_m * normal + along_m * Direction(); }
    // Where `other` crosses, as a position along this line; infinite if (nearly) parallel.
    double Crossing(const PlanLine& other) const {
        const double along = other.normal.dot(Direction());
        if (std::abs(along) < 1e-3) return HUGE_VAL;
        return (other.offset_m - other.normal.dot(offset_m * normal)) / along;
    }
};

struct Interval {
    double low = 0, high = 0;
    double Length() const { return high - low; }
    double Overlap(const Interval& other) const {
        return std::max(0.0, std::min(high, other.high) - std::max(low, other.low));
    }
    bool operator==(const Interval&) const = default;
};

// Sorted, with everything joined that is at most `gap_m` apart.
inline std::vector<Interval> Joined(std::vector<Interval> parts, double gap_m) {
    std::ranges::sort(parts, {}, &Interval::low);
    std::vector<Interval> joined;
    for (const Interval& part : parts)
        if (!joined.empty() && part.low <= joined.back().high + gap_m)
            joined.back().high = std::max(joined.back().high, part.high);
        else
            joined.push_back(part);
    return joined;
}

// What is in `parts` and not in `holes`; both sorted and joined.
inline std::vector<Interval> Without(const std::vector<Interval>& parts,
                                     const std::vector<Interval>& holes) {
    std::vector<Interval> rest;
    for (Interval part : parts) {
        for (const Interval& hole : holes) {
            if (hole.high <= part.low || hole.low >= part.high) continue;
            if (hole.low > part.low) rest.push_back({part.low, hole.low});
            part.low = std::min(part.high, hole.high);
        }
        if (part.Length() > 0) rest.push_back(part);
    }
    return rest;
}

inline double OverlapWith(const std::vector<Interval>& parts, const Interval& interval) {
    double sum = 0;
    for (const Interval& part : parts) sum += part.Overlap(interval);
    return sum;
}

// Positive if counter-clockwise.
inline double SignedArea(const Polygon2d& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return twice / 2;
}

inline double PerimeterOf(const Polygon2d& polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        sum += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
    return sum;
}

inline bool Contains(const Polygon2d& polygon, const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Eigen::Vector2d &a = polygon[i], &b = polygon[j];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
            inside = !inside;
    }
    return inside;
}

}  // namespace tessera
