// The hot loops of tracking and fusion as one would write them without vectors: the shared kernel
// templates with plain floats, one point or voxel at a time. What the vector code is compared with.
#pragma once

#include "mapping/fusion_rows.h"
#include "tracking/sdf_rows.h"

namespace tessera::bench {

// As SumSdfPoints, without residuals per point.
void SumSdfPointsScalar(const SdfArguments& arguments, int first, int last, double* sums);

// As FuseBlocks, for a camera that stands still.
void FuseBlocksScalar(const FusionArguments& arguments, const std::int32_t* blocks,
                      std::int32_t count);

}  // namespace tessera::bench
