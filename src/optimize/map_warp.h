// A map that follows its keyframes without being fused again: every voxel takes the values from
// where its surface was. Where frames that saw the same surface move apart, and where two parts of
// the map come to lie on each other, values cannot be moved; these blocks are left out, to be fused
// again.
#pragma once

#include <memory>
#include <vector>

#include "mapping/map_volume.h"
#include "optimize/map_motion.h"

namespace tessera {

struct WarpedMap {
    std::unique_ptr<BlockMap> map;
    // Blocks that are not in `map`, to be fused again; sorted.
    std::vector<BlockCoord> again;
    // kBlockVoxels for each of them, moved like the others; empty if the map has none.
    std::vector<VoxelLabel> again_labels;
};

// `motions`: by BlockId. Blocks in which shifts differ by more than this standard deviation are
// left out, blocks outside the box are dropped. Exact to first order in the differences of shifts,
// which are interpolated between blocks; a shift by whole voxels copies them. Uses TBB internally
// and gives the same result for any number of threads.
WarpedMap WarpMap(const BlockMap& map, const std::vector<BlockMotion>& motions, const WorldBox& box,
                  double most_spread_m);

}  // namespace tessera
