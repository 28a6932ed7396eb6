// The hot loop of the SDF tracker behind plain pointers: sums the normal equations over a run of
// points. Compiled twice (portable, AVX2); sdf_tracker.cpp picks. No Eigen here.
#pragma once

#include "tracking/normal_equations.h"
#include "tracking/sdf_arguments.h"

namespace tessera {

// Adds the sums (SumLayout) over points [first, last), from a multiple of kTileItems to one of
// kPointPadding, to sums[]. The same bytes on either path.
namespace baseline {
void SumSdfPoints(const SdfArguments& arguments, int first, int last, double* sums);
}
namespace avx2 {
void SumSdfPoints(const SdfArguments& arguments, int first, int last, double* sums);
}

}  // namespace tessera
