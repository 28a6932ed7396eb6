// Closed rooms: the floor is cut along all walls, and cells are joined where no wall divides them.
// Pure function, thread-safe.
#pragma once

#include "plan/floor_plan.h"
#include "plan/wall_strips.h"

namespace tessera {

struct RoomResult {
    std::vector<PlanRoom> rooms;         // largest first
    std::vector<PlanWall> unseen_walls;  // parts of their outlines that nothing showed
};

RoomResult FindRooms(const PlanEvidence& evidence, const std::vector<WallStrip>& strips,
                     double least_room_m2);

}  // namespace tessera
