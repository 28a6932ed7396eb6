#include "cuda/device_fusion.h"

#include "core/scalar_lanes.h"
#include "cuda/device_loops.h"
#include "mapping/fusion_kernels.h"
#include "mapping/visibility_kernels.h"

namespace tessera::TESSERA_DEVICE {

namespace fusion_bodies {

// Per row of the image and column of tiles. The maximum does not depend on the order.
struct WidenTile {
    const float* depth_m;
    std::int32_t width, tiles_per_row;
    float* tiles;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const std::int32_t tile_x = i % tiles_per_row, y = i / tiles_per_row;
        const float* row = depth_m + static_cast<std::int64_t>(y) * width;
        AtomicMax(tiles + y / kDepthTilePx * tiles_per_row + tile_x,
                  FarthestOfTileRow(row, width, tile_x));
    }
};

// Per voxel of the listed blocks: neighbours along x are neighbours in memory.
struct FuseVoxel {
    FusionArguments arguments;
    const std::int32_t* blocks;

    TESSERA_HD_MEMBER void operator()(int i) const {
        using Kernels = FusionKernels<ScalarLanes>;
        const int x = i % kBlockSide, y = i / kBlockSide % kBlockSide,
                  z = i / (kBlockSide * kBlockSide) % kBlockSide;
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

void BuildDepthTiles(Stream& stream, const float* depth_m, std::int32_t width, std::int32_t height,
                     float* tiles) {
    const std::int32_t columns = (width + kDepthTilePx - 1) / kDepthTilePx,
                       rows = (height + kDepthTilePx - 1) / kDepthTilePx;
    stream.Fill(tiles, 0,
                static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * sizeof(float));
    ForEach(stream, columns * height, fusion_bodies::WidenTile{depth_m, width, columns, tiles});
}

void FuseBlocks(Stream& stream, const FusionArguments& arguments, const std::int32_t* blocks,
                std::int32_t count, std::uint32_t* revisions, std::uint32_t revision) {
    ForEach(stream, count * kBlockVoxels, fusion_bodies::FuseVoxel{arguments, blocks});
    ForEach(stream, count, fusion_bodies::MarkRevision{blocks, revisions, revision});
}

}  // namespace tessera::TESSERA_DEVICE
