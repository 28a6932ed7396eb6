// The hot loop of the prealignment behind plain pointers: its sums over a range of points. Compiled
// twice (portable, AVX2); image_aligner.cpp selects the version. No Eigen here.
#pragma once

#include "tracking/align_arguments.h"

namespace tessera {

// Like SumSdfPoints (sdf_simd.h), with the sums of AlignKernels.
namespace baseline {
void SumAlignedPoints(const AlignArguments& arguments, int first, int last, double* sums);
}
namespace avx2 {
void SumAlignedPoints(const AlignArguments& arguments, int first, int last, double* sums);
}

}  // namespace tessera
