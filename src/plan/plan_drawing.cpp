#include "plan/plan_drawing.h"

#include <fmt/format.h>

namespace tessera {
namespace {

constexpr double kOffset_m = 0.22;  // of a dimension line from its wall
constexpr double kShortest_m = 0.4;

// How far the back of a wall is longer than its front at `end`, where another wall meets it: 1 at
// a room's corner, -1 at a corner that projects into the room, 0 if nothing is there.
double Mitre(const FloorPlan& plan, const PlanWall& wall, const Eigen::Vector2d& end) {
    constexpr double kNear_m = 0.03;
    for (const PlanWall& other : plan.walls) {
        if (&other == &wall || other.thickness_m || !other.seen) continue;
        for (const auto& [near, far] :
             {std::pair{other.begin, other.end}, {other.end, other.begin}}) {
            const double side = wall.normal.dot(far - near);
            if ((near - end).norm() < kNear_m && std::abs(side) > 0.7 * (far - near).norm())
                return side > 0 ? 1 : -1;
        }
    }
    return 0;
}

PlanDimension Before(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                     const Eigen::Vector2d& normal) {
    const Eigen::Vector2d away = kOffset_m * normal;
    return {from + away, to + away, away, (to - from).norm()};
}

// The same extent along the same direction.
bool Repeats(const PlanDimension& a, const PlanDimension& b) {
    constexpr double kSame_m = 0.01;
    const Eigen::Vector2d along = (b.to - b.from).normalized();
    const double low = along.dot(b.from), high = along.dot(b.to);
    const double from = along.dot(a.from), to = along.dot(a.to);
    return std::abs(std::min(from, to) - low) < kSame_m &&
           std::abs(std::max(from, to) - high) < kSame_m;
}

bool OnARoom(const FloorPlan& plan, const PlanWall& wall) {
    const double before_m = wall.thickness_m.value_or(0) / 2 + 0.1;
    return std::ranges::any_of(plan.rooms, [&](const PlanRoom& room) {
        for (const double share : {0.2, 0.5, 0.8}) {
            const Eigen::Vector2d p = wall.begin + share * (wall.end - wall.begin);
            if (Contains(room.outline, p + before_m * wall.normal) ||
                Contains(room.outline, p - before_m * wall.normal))
                return true;
        }
        return false;
    });
}

}  // namespace

Polygon2d WallOutline(const FloorPlan& plan, const PlanWall& wall) {
    const Eigen::Vector2d along = (wall.end - wall.begin).normalized();
    if (wall.thickness_m) {
        const Eigen::Vector2d half = *wall.thickness_m / 2 * wall.normal;
        return {wall.begin + half, wall.end + half, wall.end - half, wall.begin - half};
    }
    const Eigen::Vector2d back = -kDrawnThickness_m * wall.normal;
    return {wall.begin, wall.end,
            wall.end + back + Mitre(plan, wall, wall.end) * kDrawnThickness_m * along,
            wall.begin + back - Mitre(plan, wall, wall.begin) * kDrawnThickness_m * along};
}

Polygon2d OpeningOutline(const PlanOpening& opening) {
    const Eigen::Vector2d half =
        opening.thickness_m.value_or(kDrawnThickness_m) / 2 * opening.normal;
    const Eigen::Vector2d front = opening.thickness_m ? half : Eigen::Vector2d::Zero().eval(),
                          back = opening.thickness_m ? half : Eigen::Vector2d(2 * half);
    return {opening.begin + front, opening.end + front, opening.end - back, opening.begin - back};
}

std::vector<PlanDimension> Dimensions(const FloorPlan& plan) {
    std::vector<PlanDimension> all;
    for (const PlanRoom& room : plan.rooms) {
        std::vector<PlanDimension> own;
        for (std::size_t i = 0; i < room.outline.size(); ++i) {
            const Eigen::Vector2d &a = room.outline[i],
                                  &b = room.outline[(i + 1) % room.outline.size()];
            if ((b - a).norm() < kShortest_m) continue;
            const Eigen::Vector2d along = (b - a).normalized();
            const PlanDimension dimension = Before(a, b, {-along.y(), along.x()});
            if (std::ranges::none_of(
                    own, [&](const PlanDimension& other) { return Repeats(dimension, other); }))
                own.push_back(dimension);
        }
        all.insert(all.end(), own.begin(), own.end());
    }
    for (const PlanWall& wall : plan.walls)
        if (wall.seen && wall.Length() >= kShortest_m && !OnARoom(plan, wall)) {
            const Eigen::Vector2d front = wall.thickness_m.value_or(0) / 2 * wall.normal;
            all.push_back(Before(wall.begin + front, wall.end + front, wall.normal));
        }
    return all;
}

std::string MeasureText(double length_m) { return fmt::format("{:.2f}", length_m); }

Eigen::AlignedBox2d Bounds(const FloorPlan& plan) {
    Eigen::AlignedBox2d bounds;
    const auto add = [&](const Polygon2d& points) {
        for (const Eigen::Vector2d& point : points) bounds.extend(point);
    };
    for (const PlanWall& wall : plan.walls) add(WallOutline(plan, wall));
    for (const PlanRoom& room : plan.rooms) add(room.outline);
    for (const PlanObject& object : plan.objects) add(object.outline);
    add(plan.floor_cells);
    if (bounds.isEmpty()) add({Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(0.5, 0.5)});
    return bounds;
}

}  // namespace tessera
