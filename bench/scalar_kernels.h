// The hot loops of tracking and fusion as one would write them without SIMD: the shared kernel
// templates in scalar float, one point or voxel at a time. The baseline for the SIMD code.
#pragma once

#include "mapping/fusion_simd.h"
#include "tracking/sdf_simd.h"

namespace tessera::bench {

// Like SumSdfPoints, but without residuals per point.
void SumSdfPointsScalar(const SdfArguments& arguments, int first, int last, double* sums);

// Like FuseBlocks, for a stationary camera.
void FuseBlocksScalar(const FusionArguments& arguments, const std::int32_t* blocks,
                      std::int32_t count);

}  // namespace tessera::bench
