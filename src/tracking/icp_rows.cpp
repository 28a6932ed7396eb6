#include "tracking/icp_rows.h"

#include "core/vector_lanes.h"
#include "tracking/icp_kernels.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {

void SumIcpPoints(const IcpArguments& a, int first, int last, double* sums) {
    static_assert(kPointPadding % VectorLanes::kCount == 0);
    VectorLanes::Real lanes[SumLayout::kCount];
    for (VectorLanes::Real& value : lanes) value = VectorLanes::Real(0.0f);
    for (int i = first; i < last; i += VectorLanes::kCount) IcpKernels<VectorLanes>::AddPoints(a, i, lanes);
    for (int k = 0; k < SumLayout::kCount; ++k) sums[k] += static_cast<double>(xsimd::hadd(lanes[k]));
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
