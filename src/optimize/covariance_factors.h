// What the covariances of alignments and of tracking leave out, as the recording itself shows it.
#pragma once

#include <optional>
#include <span>

#include "optimize/keyframes.h"
#include "optimize/pose_graph.h"

namespace tessera {

// The factors by which covariances must grow, at least 1.
struct CovarianceFactors {
    // Of alignments: errors that are the same in many views (a lens, a rolling shutter, a bent
    // depth) are not in an alignment's own covariance.
    double aligned = 1;
    // Of tracking: a drift that is larger than tracking's drift usually is.
    double tracked = 1;
};

// `aligned` while nothing is known against tracking: what explains how alignments with the last few
// keyframes differ from it (three quarters of them; a slide spoils fewer). Empty while there are
// too few. An alignment that this factor does not explain shows drift.
std::optional<double> AlignedFactor(const Keyframes& keyframes);

// Variance components, once drift is shown: `tracked` explains what AlignedFactor leaves of three
// quarters of the differences between tracking and alignments with older keyframes, and `aligned`
// what is then left between neighbours. A drift that is spread evenly over the path looks like an
// error of the alignments to AlignedFactor. `edges`: those that are not loops give the covariance
// of tracking between consecutive keyframes.
std::optional<CovarianceFactors> FindCovarianceFactors(const Keyframes& keyframes,
                                                       std::span<const PoseEdge> edges);

}  // namespace tessera
