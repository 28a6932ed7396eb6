// The hot loop of the ICP tracker behind plain pointers: projective association with the predicted
// view and the normal equations, over a run of points. Compiled twice (portable, AVX2);
// icp_tracker.cpp picks. No Eigen here.
//
// Which points have partners changes with the pose. So that a step can be judged, energies are
// summed over the residuals that exist at both poses.
#pragma once

#include "tracking/icp_arguments.h"
#include "tracking/normal_equations.h"

namespace tessera {

// Adds the sums (SumLayout) over points [first, last), from a multiple of kTileItems to one of
// kPointPadding, to sums[]. The same bytes on either path.
namespace baseline {
void SumIcpPoints(const IcpArguments& arguments, int first, int last, double* sums);
}
namespace avx2 {
void SumIcpPoints(const IcpArguments& arguments, int first, int last, double* sums);
}

}  // namespace tessera
