// The hot loop of the prealignment behind plain pointers: its sums over a run of points. Compiled
// twice (portable, AVX2); image_aligner.cpp picks. No Eigen here.
#pragma once

#include "tracking/align_arguments.h"

namespace tessera {

// As SumSdfPoints (sdf_rows.h) of AlignKernels' sums.
namespace baseline {
void SumAlignedPoints(const AlignArguments& arguments, int first, int last, double* sums);
}
namespace avx2 {
void SumAlignedPoints(const AlignArguments& arguments, int first, int last, double* sums);
}

}  // namespace tessera
