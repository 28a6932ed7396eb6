// Walls from their faces: which two faces are one wall, where it is solid, and where its openings
// are. Pure function, thread-safe.
#pragma once

#include <optional>
#include <vector>

#include "plan/wall_faces.h"

namespace tessera {

struct StripOpening {
    Interval along;
    std::optional<double> height_m;  // of the lintel
};

// One straight wall, which may be interrupted. Positions are along `front`.
struct WallStrip {
    PlanLine front;          // its normal points to where the larger face was seen from
    double thickness_m = 0;  // 0: only one face was seen
    std::vector<std::uint32_t> front_members, back_members;  // upright points
    std::vector<Interval> solid;                             // sorted, apart
    std::vector<Interval> both;                              // where both faces were seen
    std::vector<Interval> front_seen;                        // where the front was
    std::vector<StripOpening> openings;
    double height_m = 0, rms_m = 0, area_m2 = 0;

    PlanLine Back() const { return {front.normal, front.offset_m - thickness_m}; }
};

// Largest first. `noise_m` as in WallFaceOptions.
std::vector<WallStrip> FindWallStrips(const PlanEvidence& evidence, std::vector<WallFace> faces,
                                      double noise_m);

}  // namespace tessera
