#include "tracking/align_simd.h"

#include "core/tile_sums.h"
#include "core/vector_lanes.h"
#include "tracking/align_kernels.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {

void SumAlignedPoints(const AlignArguments& a, int first, int last, double* sums) {
    static_assert(kPointPadding % VectorLanes::kCount == 0);
    const auto add = [&](int i, VectorLanes::Real* lanes) {
        AlignKernels<VectorLanes>::AddPoints(a, i, lanes);
    };
    AddTiles<VectorLanes, SumLayout::kCount>(first, last, add, sums);
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
