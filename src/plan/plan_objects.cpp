#include "plan/plan_objects.h"

#include <algorithm>

namespace tessera {
namespace {

double Turned(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// Andrew's monotone chain, counter-clockwise.
Polygon2d ConvexHull(Polygon2d points) {
    std::ranges::sort(points, [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
    });
    Polygon2d hull;
    for (int pass = 0; pass < 2; ++pass) {
        const std::size_t begin = hull.size();
        for (const Eigen::Vector2d& point : points) {
            while (hull.size() >= begin + 2 &&
                   Turned(hull[hull.size() - 2], hull.back(), point) <= 1e-9)
                hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back();
        std::ranges::reverse(points);
    }
    return hull;
}

}  // namespace

void AddObjects(const std::vector<MapObject>& objects, FloorPlan& plan) {
    for (const MapObject& object : objects) {
        const Eigen::Vector3d half = object.oriented_size / 2;
        if (!half.allFinite() || half.minCoeff() <= 0 ||
            !object.T_world_oriented.matrix().allFinite())
            continue;
        PlanObject drawn{object.class_name, object.id, {}, HUGE_VAL, -HUGE_VAL};
        Polygon2d corners;
        for (int i = 0; i < 8; ++i) {
            const Eigen::Vector3d corner(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                                         i & 4 ? half.z() : -half.z());
            const Eigen::Vector3d p = plan.T_plan_world * (object.T_world_oriented * corner);
            corners.push_back(p.head<2>());
            drawn.low_m = std::min(drawn.low_m, p.z());
            drawn.high_m = std::max(drawn.high_m, p.z());
        }
        drawn.outline = ConvexHull(std::move(corners));
        if (drawn.outline.size() >= 3) plan.objects.push_back(std::move(drawn));
    }
}

}  // namespace tessera
