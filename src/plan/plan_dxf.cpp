#include <fmt/format.h>

#include "plan/dxf.h"
#include "plan/plan_drawing.h"
#include "plan/plan_files.h"

namespace tessera {
namespace {

// Upright as seen from below or from the right, whichever way a line runs.
double ReadableAngle(const Eigen::Vector2d& along) {
    const double angle = std::atan2(along.y(), along.x());
    const double half = std::acos(-1.0) / 2;
    return angle > half + 1e-6     ? angle - 2 * half
           : angle <= -half + 1e-6 ? angle + 2 * half
                                   : angle;
}

void DrawDimension(const PlanDimension& dimension, DxfDrawing& drawing) {
    const Eigen::Vector2d along = (dimension.to - dimension.from).normalized();
    drawing.Line("DIMENSIONS", dimension.from, dimension.to);
    for (const Eigen::Vector2d& end : {dimension.from, dimension.to}) {
        drawing.Line("DIMENSIONS", end - 0.8 * dimension.away, end + 0.2 * dimension.away);
        const Eigen::Vector2d tick = 0.03 * (along + dimension.away.normalized());
        drawing.Line("DIMENSIONS", end - tick, end + tick);
    }
    drawing.Text("DIMENSIONS",
                 (dimension.from + dimension.to) / 2 + 0.07 * dimension.away.normalized(), 0.09,
                 MeasureText(dimension.length_m), ReadableAngle(along));
}

}  // namespace

std::string PlanDxf(const FloorPlan& plan) {
    DxfDrawing drawing({{"WALLS", 7},
                        {"OPENINGS", 3},
                        {"ROOMS", 5},
                        {"OBJECTS", 8},
                        {"DIMENSIONS", 1},
                        {"TEXT", 7}},
                       "Tessera floor plan; one drawing unit is one metre");
    for (const PlanWall& wall : plan.walls)
        if (wall.thickness_m)
            drawing.Polyline("WALLS", WallOutline(plan, wall), true);
        else
            drawing.Line("WALLS", wall.begin, wall.end);
    for (const PlanOpening& opening : plan.openings) {
        if (opening.thickness_m)
            drawing.Polyline("OPENINGS", OpeningOutline(opening), true);
        else
            drawing.Line("OPENINGS", opening.begin, opening.end);
        const Eigen::Vector2d along = opening.end - opening.begin;
        drawing.Text("TEXT", (opening.begin + opening.end) / 2 + 0.25 * opening.normal, 0.09,
                     MeasureText(opening.Width()), ReadableAngle(along));
    }
    for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
        const PlanRoom& room = plan.rooms[i];
        drawing.Polyline("ROOMS", room.outline, true);
        for (const Polygon2d& hole : room.holes) drawing.Polyline("ROOMS", hole, true);
        drawing.Text("TEXT", room.label_at, 0.18, fmt::format("Room {}", i + 1), 0);
        drawing.Text("TEXT", room.label_at - Eigen::Vector2d(0, 0.3), 0.18,
                     fmt::format("{:.2f} m2", room.area_m2), 0);
    }
    for (const PlanObject& object : plan.objects) {
        drawing.Polyline("OBJECTS", object.outline, true);
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        for (const Eigen::Vector2d& corner : object.outline) middle += corner;
        drawing.Text("OBJECTS", middle / static_cast<double>(object.outline.size()), 0.08,
                     object.name, 0);
    }
    for (const PlanDimension& dimension : Dimensions(plan)) DrawDimension(dimension, drawing);
    return drawing.Finish();
}

}  // namespace tessera
