// The hot loop of the ICP tracker behind plain pointers: projective association with the predicted
// view and the normal equations, over a range of points. Compiled twice (portable, AVX2);
// cpu_sums.cpp selects the version. No Eigen here.
//
// The set of associated points changes with the pose. To judge a step, energies are summed over the
// residuals that exist at both poses.
#pragma once

#include "tracking/icp_arguments.h"
#include "tracking/normal_equations.h"

namespace tessera {

// Adds the sums (SumLayout) over points [first, last) to sums[]. `first` is a multiple of
// kTileItems, `last` of kPointPadding. Both versions give the same bytes.
namespace baseline {
void SumIcpPoints(const IcpArguments& arguments, int first, int last, double* sums);
}
namespace avx2 {
void SumIcpPoints(const IcpArguments& arguments, int first, int last, double* sums);
}

}  // namespace tessera
