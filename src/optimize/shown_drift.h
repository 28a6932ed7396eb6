// The drift of tracking that direct alignment of keyframes shows.
#pragma once

#include "optimize/keyframes.h"
#include "optimize/loop_verifier.h"

namespace tessera {

struct ShownDrift {
    const Keyframe* old = nullptr;  // the other end of the largest drift; null if none is shown
    Drift drift;
    // A solution of the graph costs more the larger the scan. Drift that earlier keyframes show,
    // too, came to nothing, and is worth another solution only from time to time.
    bool worth_a_solution = false;
};

// What the last few keyframes show. `aligned_factor`: CovarianceFactors::aligned. `least_m`: what
// counts. `max_drift`: LoopConfig::max_drift.
ShownDrift FindShownDrift(const Keyframes& keyframes, double aligned_factor, double least_m,
                          double max_drift);

}  // namespace tessera
