// Computes the trackers' sums with their kernels, one point at a time. The SIMD and CUDA code must
// agree with them.
#pragma once

#include "core/scalar_lanes.h"
#include "core/tile_sums.h"
#include "tracking/normal_equations.h"

namespace tessera::testing_support {

// Kernels: SdfKernels<ScalarLanes> or IcpKernels<ScalarLanes>.
template <class Kernels, class Arguments>
void SumOneByOne(const Arguments& a, int first, int last, double* sums) {
    const auto add = [&](int i, float* lanes) { Kernels::AddPoints(a, i, lanes); };
    AddTiles<ScalarLanes, SumLayout::kCount>(first, last, add, sums);
}

}  // namespace tessera::testing_support
