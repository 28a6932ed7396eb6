// The hot loop of the SDF tracker behind plain pointers: sums the normal equations over a range of
// points. Compiled twice (portable, AVX2); cpu_sums.cpp selects the version. No Eigen here.
#pragma once

#include "tracking/normal_equations.h"
#include "tracking/sdf_arguments.h"

namespace tessera {

// Adds the sums (SumLayout) over points [first, last) to sums[]. `first` is a multiple of
// kTileItems, `last` of kPointPadding. Both versions give the same bytes.
namespace baseline {
void SumSdfPoints(const SdfArguments& arguments, int first, int last, double* sums);
}
namespace avx2 {
void SumSdfPoints(const SdfArguments& arguments, int first, int last, double* sums);
}

}  // namespace tessera
