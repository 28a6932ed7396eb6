#include <nlohmann/json.hpp>

#include "io/file.h"
#include "plan/plan_files.h"

namespace tessera {
namespace {

using nlohmann::json;

// To a tenth of a millimetre.
double Rounded(double value) { return std::round(value * 1e4) / 1e4; }

json Point(const Eigen::Vector2d& p) { return json::array({Rounded(p.x()), Rounded(p.y())}); }

json Points(const Polygon2d& polygon) {
    json points = json::array();
    for (const Eigen::Vector2d& p : polygon) points.push_back(Point(p));
    return points;
}

json Optional(const std::optional<double>& value) {
    return value ? json(Rounded(*value)) : json(nullptr);
}

json Walls(const FloorPlan& plan) {
    json walls = json::array();
    for (const PlanWall& wall : plan.walls)
        walls.push_back(json::object({{"begin", Point(wall.begin)},
                                      {"end", Point(wall.end)},
                                      {"length", Rounded(wall.Length())},
                                      {"normal", Point(wall.normal)},
                                      {"thickness", Optional(wall.thickness_m)},
                                      {"height", Optional(wall.height_m)},
                                      {"rms", Rounded(wall.rms_m)},
                                      {"seen", wall.seen}}));
    return walls;
}

json Openings(const FloorPlan& plan) {
    json openings = json::array();
    for (const PlanOpening& opening : plan.openings)
        openings.push_back(json::object({{"begin", Point(opening.begin)},
                                         {"end", Point(opening.end)},
                                         {"width", Rounded(opening.Width())},
                                         {"height", Optional(opening.height_m)},
                                         {"thickness", Optional(opening.thickness_m)}}));
    return openings;
}

json Rooms(const FloorPlan& plan) {
    json rooms = json::array();
    for (const PlanRoom& room : plan.rooms) {
        json holes = json::array();
        for (const Polygon2d& hole : room.holes) holes.push_back(Points(hole));
        rooms.push_back(json::object({{"area", Rounded(room.area_m2)},
                                      {"perimeter", Rounded(room.perimeter_m)},
                                      {"walled_share", Rounded(room.walled_share)},
                                      {"polygon", Points(room.outline)},
                                      {"holes", std::move(holes)}}));
    }
    return rooms;
}

}  // namespace

std::string PlanJson(const FloorPlan& plan) {
    json objects = json::array();
    for (const PlanObject& object : plan.objects)
        objects.push_back(json::object({{"id", object.id},
                                        {"class", object.name},
                                        {"polygon", Points(object.outline)},
                                        {"low", Rounded(object.low_m)},
                                        {"high", Rounded(object.high_m)}}));
    json transform = json::array();
    for (int row = 0; row < 4; ++row) {
        json values = json::array();
        for (int column = 0; column < 4; ++column)
            values.push_back(plan.T_plan_world.matrix()(row, column));
        transform.push_back(std::move(values));
    }
    const json all = json::object({{"units", "metres"},
                                   {"T_plan_world", std::move(transform)},
                                   {"floor_height", 0.0},
                                   {"ceiling_height", Optional(plan.ceiling_m)},
                                   {"floor_area_seen", Rounded(plan.floor_m2)},
                                   {"noise", Rounded(plan.noise_m)},
                                   {"rooms", Rooms(plan)},
                                   {"walls", Walls(plan)},
                                   {"openings", Openings(plan)},
                                   {"objects", std::move(objects)}});
    return all.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Status WritePlan(const std::string& folder, const FloorPlan& plan, const std::string& title) {
    for (Status status : {WriteTextFile(folder + "/plan.svg", PlanSvg(plan, title)),
                          WriteTextFile(folder + "/plan.dxf", PlanDxf(plan)),
                          WriteTextFile(folder + "/plan.json", PlanJson(plan))})
        if (!status.ok()) return status;
    return Status::Ok();
}

}  // namespace tessera
