#include "cuda/device_fusion.h"

#include "core/scalar_lanes.h"
#include "cuda/device_loops.h"
#include "mapping/fusion_kernels.h"
#include "mapping/visibility_kernels.h"

namespace tessera::TESSERA_DEVICE {

namespace fusion_bodies {

// Per tile.
struct BuildTile {
    const float* depth_m;
    std::int32_t width, height, tiles_per_row;
    float* tiles;

    TESSERA_HD_MEMBER void operator()(int i) const {
        tiles[i] = FarthestOfTile(depth_m, width, height, i % tiles_per_row, i / tiles_per_row);
    }
};

// Per voxel of the listed blocks: neighbours along x are neighbours in memory.
struct FuseVoxel {
    FusionArguments arguments;
    const std::int32_t* blocks;

    TESSERA_HD_MEMBER void operator()(int i) const {
        using Kernels = FusionKernels<ScalarLanes>;
        const int x = i % kBlockSide, y = i / kBlockSide % kBlockSide, z = i / (kBlockSide * kBlockSide) % kBlockSide;
        const std::int32_t block = blocks[i / kBlockVoxels];
        Kernels::FuseVoxels(arguments, Kernels::RowOf(arguments, block, y, z), x);
    }
};

// Per block.
struct MarkRevision {
    const std::int32_t* blocks;
    std::uint32_t* revisions;
    std::uint32_t revision;

    TESSERA_HD_MEMBER void operator()(int i) const { revisions[blocks[i]] = revision; }
};

}  // namespace fusion_bodies

void BuildDepthTiles(Stream& stream, const float* depth_m, std::int32_t width, std::int32_t height, float* tiles) {
    const std::int32_t columns = (width + kDepthTilePx - 1) / kDepthTilePx, rows = (height + kDepthTilePx - 1) / kDepthTilePx;
    ForEach(stream, columns * rows, fusion_bodies::BuildTile{depth_m, width, height, columns, tiles});
}

void FuseBlocks(Stream& stream, const FusionArguments& arguments, const std::int32_t* blocks, std::int32_t count,
                std::uint32_t* revisions, std::uint32_t revision) {
    ForEach(stream, count * kBlockVoxels, fusion_bodies::FuseVoxel{arguments, blocks});
    ForEach(stream, count, fusion_bodies::MarkRevision{blocks, revisions, revision});
}

}  // namespace tessera::TESSERA_DEVICE
