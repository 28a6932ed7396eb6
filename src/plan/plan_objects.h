// Objects of a run on its floor plan. Pure function, thread-safe.
#pragma once

#include <vector>

#include "plan/floor_plan.h"
#include "semantics/map_object.h"

namespace tessera {

// Adds the outlines of the objects' oriented boxes, seen from above. Objects without extent are
// left out.
void AddObjects(const std::vector<MapObject>& objects, FloorPlan& plan);

}  // namespace tessera
