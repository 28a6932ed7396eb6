// The floor plan of a run, a scan file or a mesh.
#pragma once

#include <string>

#include "core/status.h"
#include "plan/floor_plan.h"

namespace tessera {

struct PlanRequest {
    std::string input;  // the folder of a run, FILE.scan or FILE.ply
    // Which way is up in a mesh: x, y, z, -x, -y or -z; "": z. Runs and scans know it.
    std::string up;
    FloorPlanOptions options;
};

// With the objects of a run's objects.json, if it is there. Errors name the file and what to do.
Result<FloorPlan> PlanOfRun(const PlanRequest& request);

}  // namespace tessera
