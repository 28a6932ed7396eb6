#include "mapping/ray_simd.h"

#include "core/vector_lanes.h"
#include "mapping/block_cache.h"
#include "mapping/ray_kernels.h"

namespace tessera::TESSERA_VECTOR_NAMESPACE {

void CastTiles(const RayArguments& a, const RayTile* tiles, std::int32_t count) {
    using Blocks = BlockCache<VectorLanes>;
    static_assert(Blocks::kReachBlocks == kRayReachBlocks);
    using Kernels = RayKernels<VectorLanes, Blocks>;
    Kernels::Walker walker(a);
    for (std::int32_t i = 0; i < count; ++i)
        for (int v = tiles[i].v_begin; v < tiles[i].v_end; ++v)
            for (int u = tiles[i].u_begin; u < tiles[i].u_end; u += VectorLanes::kCount)
                Kernels::CastPixels(a, walker, tiles[i], u, v);
}

}  // namespace tessera::TESSERA_VECTOR_NAMESPACE
