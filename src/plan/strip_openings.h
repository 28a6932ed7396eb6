// Where one wall is solid and where its openings are. Pure functions.
#pragma once

#include "plan/wall_strips.h"

namespace tessera {

// Fills solid, both, openings and height_m from the columns of both faces. A gap with floor in it
// is an opening; one that furniture hides is wall.
void FindSolid(const PlanEvidence& evidence, WallStrip& strip);

// Joins the ends of walls to the walls that they meet, and finds openings beside such corners.
void JoinCorners(const PlanEvidence& evidence, std::vector<WallStrip>& strips);

}  // namespace tessera
