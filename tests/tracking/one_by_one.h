// The trackers' sums by their kernels one point at a time: what vectors and CUDA must agree with.
#pragma once

#include <algorithm>

#include "core/scalar_lanes.h"
#include "tracking/normal_equations.h"

namespace tessera::testing_support {

// Kernels: SdfKernels<ScalarLanes> or IcpKernels<ScalarLanes>. In short runs, so that floats keep their digits.
template <class Kernels, class Arguments>
void SumOneByOne(const Arguments& a, int count, double* sums) {
    constexpr int kRun = 64;
    for (int first = 0; first < count; first += kRun) {
        float run[SumLayout::kCount] = {};
        for (int i = first; i < std::min(first + kRun, count); ++i) Kernels::AddPoints(a, i, run);
        for (int k = 0; k < SumLayout::kCount; ++k) sums[k] += static_cast<double>(run[k]);
    }
}

}  // namespace tessera::testing_support
