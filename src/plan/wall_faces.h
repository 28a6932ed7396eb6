// Straight upright surfaces that are walls: found by their direction and offset, fitted robustly,
// and told from furniture by their height. Pure function, thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/plan_evidence.h"
#include "plan/plan_geometry.h"

namespace tessera {

struct WallFaceOptions {
    double noise_m = 0.01;  // standard deviation of a surface; bands and gates follow from it
    double least_length_m = 0.2;
    double least_area_m2 = 0.25;
};

struct WallFace {
    PlanLine line;  // the normal points away from the wall
    Interval along;
    double rms_m = 0;  // of its points from the line
    double area_m2 = 0;
    std::vector<std::uint32_t> members;  // upright points
};

// Largest first. Directions that are the same or square to each other within their own errors are
// made so.
std::vector<WallFace> FindWallFaces(const PlanEvidence& evidence, const WallFaceOptions& options);

}  // namespace tessera
