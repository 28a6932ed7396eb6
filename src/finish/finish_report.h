// What finishing a model did, in figures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "finish/flaps.h"
#include "finish/holes.h"
#include "finish/islands.h"

namespace tessera {

struct LevelReport {  // of detail
    std::size_t triangles = 0;
    // From the scanned surface, metres, by the quadrics' measure: the sum of all levels' so far.
    double error_m = 0;
    std::size_t charts = 0;
    int width = 0, height = 0;  // of the texture, texels
    double texel_m = 0;         // reached
    double seen_share = 0;      // of the texels that a view shows
};

struct FinishReport {
    std::size_t triangles_before = 0;
    std::size_t evidence_frames = 0;  // whose depth the surface was compared with
    RemovedFlaps flaps;
    RemovedIslands islands;
    ClosedHoles holes;
    std::int64_t frames = 0;          // read for the texture
    std::int64_t views = 0;           // of them, that the texture was made from
    std::vector<LevelReport> levels;  // the model, then each lower level

    const LevelReport& model() const { return levels.front(); }
};

// finish.json: lengths in metres, areas in square metres.
std::string FinishReportJson(const FinishReport& report);

}  // namespace tessera
