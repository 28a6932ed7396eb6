#include "mapping/fusion_simd.h"

#include "core/vector_lanes.h"
#include "mapping/fusion_kernels.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {

void FuseBlocks(const FusionArguments& a, const std::int32_t* blocks, std::int32_t count) {
    using Kernels = FusionKernels<VectorLanes>;
    static_assert(kBlockSide % VectorLanes::kCount == 0);
    for (std::int32_t b = 0; b < count; ++b)
        for (int z = 0; z < kBlockSide; ++z)
            for (int y = 0; y < kBlockSide; ++y) {
                const Kernels::Row row = Kernels::RowOf(a, blocks[b], y, z);
                for (int x = 0; x < kBlockSide; x += VectorLanes::kCount)
                    Kernels::FuseVoxels(a, row, x);
            }
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
