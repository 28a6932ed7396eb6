#include "plan/plan_rooms.h"

#include <map>
#include <numeric>

#include "plan/room_cells.h"

namespace tessera {
namespace {

constexpr double kDivides = 0.5;      // a share of wall that divides two cells
constexpr double kLeastWalled = 0.7;  // of a closed room's perimeter
constexpr double kLeastWidth_m = 0.4;

struct BorderEdge {
    Eigen::Vector2d from, to;
    int line = 0;
    double walled = 0;  // share
};

// Joins cells; the representative of each.
std::vector<int> Components(const RoomCells& rooms) {
    const std::vector<ArrangementCell>& cells = rooms.arrangement().cells();
    std::vector<int> parent(cells.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int i) {
        while (parent[static_cast<std::size_t>(i)] != i)
            i = parent[static_cast<std::size_t>(i)] =
                parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
        return i;
    };
    for (int i = 0; i < static_cast<int>(cells.size()); ++i) {
        const ArrangementCell& cell = cells[static_cast<std::size_t>(i)];
        for (std::size_t e = 0; e < cell.edges.size(); ++e)
            if (const int other = cell.edges[e].neighbour;
                rooms.Inside(i) && rooms.Inside(other) && rooms.Walled(cell, e) < kDivides)
                parent[static_cast<std::size_t>(root(other))] = root(i);
    }
    for (int i = 0; i < static_cast<int>(cells.size()); ++i)
        parent[static_cast<std::size_t>(i)] = root(i);
    return parent;
}

std::map<int, std::vector<BorderEdge>> BordersOf(const RoomCells& rooms) {
    const std::vector<ArrangementCell>& cells = rooms.arrangement().cells();
    const std::vector<int> component = Components(rooms);
    std::map<int, std::vector<BorderEdge>> borders;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (!rooms.Inside(static_cast<int>(i))) continue;
        for (std::size_t e = 0; e < cells[i].edges.size(); ++e) {
            const ArrangementCell::Edge& edge = cells[i].edges[e];
            if (rooms.Inside(edge.neighbour) &&
                component[static_cast<std::size_t>(edge.neighbour)] == component[i])
                continue;
            borders[component[i]].push_back({cells[i].corners[e],
                                             cells[i].corners[(e + 1) % cells[i].corners.size()],
                                             edge.line, rooms.Walled(cells[i], e)});
        }
    }
    return borders;
}

// Takes edges that follow one another until the loop closes. Corners within a millimetre are one.
std::vector<BorderEdge> TakeLoop(std::vector<BorderEdge>& edges) {
    std::vector<BorderEdge> loop{edges.back()};
    edges.pop_back();
    while ((loop.back().to - loop.front().from).norm() > 1e-3) {
        const auto next = std::ranges::min_element(edges, {}, [&](const BorderEdge& edge) {
            return (edge.from - loop.back().to).squaredNorm();
        });
        if (next == edges.end() || (next->from - loop.back().to).norm() > 1e-3) return loop;
        loop.push_back(*next);
        edges.erase(next);
    }
    return loop;
}

// Corners where the direction changes.
Polygon2d CornersOf(const std::vector<BorderEdge>& loop) {
    Polygon2d corners;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const BorderEdge& before = loop[(i + loop.size() - 1) % loop.size()];
        const Eigen::Vector2d a = (before.to - before.from).normalized(),
                              b = (loop[i].to - loop[i].from).normalized();
        if (a.dot(b) < 0.99999) corners.push_back(loop[i].from);
    }
    return corners;
}

// Of a grid of points the one that is farthest from the outline.
Eigen::Vector2d LabelPlace(const PlanRoom& room) {
    constexpr int kGrid = 40;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : room.outline) box.extend(corner);
    std::vector<Polygon2d> loops = room.holes;
    loops.push_back(room.outline);
    const auto clearance = [&](const Eigen::Vector2d& p) {
        double nearest = HUGE_VAL;
        for (const Polygon2d& loop : loops)
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const Eigen::Vector2d side = loop[(i + 1) % loop.size()] - loop[i];
                const double t = std::clamp((p - loop[i]).dot(side) / side.squaredNorm(), 0.0, 1.0);
                nearest = std::min(nearest, (p - loop[i] - t * side).norm());
            }
        return nearest;
    };
    // Of places that are about as good the one nearest to the middle.
    Eigen::Vector2d best = box.center();
    double most = -HUGE_VAL;
    for (int i = 1; i < kGrid; ++i)
        for (int k = 1; k < kGrid; ++k) {
            const Eigen::Vector2d p =
                box.min() + box.sizes().cwiseProduct(Eigen::Vector2d(i, k)) / kGrid;
            if (!Contains(room.outline, p)) continue;
            const double value = clearance(p) - 0.2 * (p - box.center()).norm();
            if (value > most) most = value, best = p;
        }
    return best;
}

PlanRoom RoomOf(const std::vector<std::vector<BorderEdge>>& loops) {
    PlanRoom room;
    double walled_m = 0;
    for (const std::vector<BorderEdge>& loop : loops) {
        const Polygon2d corners = CornersOf(loop);
        if (corners.size() < 3) continue;
        room.area_m2 += SignedArea(corners);
        room.perimeter_m += PerimeterOf(corners);
        for (const BorderEdge& edge : loop) walled_m += edge.walled * (edge.to - edge.from).norm();
        if (SignedArea(corners) > 0)
            room.outline = corners;
        else
            room.holes.push_back(corners);
    }
    room.walled_share = room.perimeter_m > 0 ? walled_m / room.perimeter_m : 0;
    return room;
}

}  // namespace

RoomResult FindRooms(const PlanEvidence& evidence, const std::vector<WallStrip>& strips,
                     double least_room_m2) {
    RoomResult result;
    const RoomCells cells(evidence, strips);
    for (auto& [component, edges] : BordersOf(cells)) {
        std::vector<std::vector<BorderEdge>> loops;
        while (!edges.empty()) loops.push_back(TakeLoop(edges));
        PlanRoom room = RoomOf(loops);
        if (room.outline.empty() || room.area_m2 < least_room_m2 ||
            room.walled_share < kLeastWalled || 2 * room.area_m2 < kLeastWidth_m * room.perimeter_m)
            continue;
        room.label_at = LabelPlace(room);
        result.rooms.push_back(std::move(room));
        for (const std::vector<BorderEdge>& loop : loops)
            for (const BorderEdge& edge : loop) {
                if (edge.walled >= kDivides || (edge.to - edge.from).norm() < 0.05) continue;
                PlanWall wall;
                wall.begin = edge.from;
                wall.end = edge.to;
                const Eigen::Vector2d along = (edge.to - edge.from).normalized();
                wall.normal = {-along.y(), along.x()};  // to the inside, on the left
                wall.seen = false;
                result.unseen_walls.push_back(wall);
            }
    }
    std::ranges::stable_sort(result.rooms, std::greater<>(), &PlanRoom::area_m2);
    return result;
}

}  // namespace tessera
