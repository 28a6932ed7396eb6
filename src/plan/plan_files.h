// Writes a floor plan: SVG to look at and print, DXF for CAD programs, JSON for programs. The
// texts are pure functions, thread-safe.
#pragma once

#include <string>

#include "plan/floor_plan.h"

namespace tessera {

// A drawing at a usual scale (1:50 and so on), in millimetres of paper. `title` names what was
// scanned.
std::string PlanSvg(const FloorPlan& plan, const std::string& title);
// DXF R12 in metres; layers WALLS, OPENINGS, ROOMS, OBJECTS, DIMENSIONS, TEXT.
std::string PlanDxf(const FloorPlan& plan);
// Everything, in metres in the plan frame, with the transform into it.
std::string PlanJson(const FloorPlan& plan);

// plan.svg, plan.dxf and plan.json in a folder that exists.
Status WritePlan(const std::string& folder, const FloorPlan& plan, const std::string& title);

}  // namespace tessera
