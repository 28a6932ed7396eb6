// A map that follows its keyframes without being fused again: every voxel takes the values from
// where its surface was. Where frames that saw the same surface move apart, and where two parts of
// the map come to lie on each other, that is only roughly right: these blocks are doubtful, to be
// fused again.
#pragma once

#include <memory>
#include <vector>

#include "optimize/block_mover.h"
#include "optimize/map_motion.h"

namespace tessera {

struct WarpedMap {
    std::unique_ptr<BlockMap> map;
    bool whole = false;  // with the doubtful blocks
    // Blocks in which shifts disagree, to be fused again; sorted.
    std::vector<BlockCoord> doubtful;
    // If the map is not whole: these, moved as well as possible.
    std::unique_ptr<BlockMap> rough;
};

// Moves a map, some blocks at a time. Uses TBB internally and gives the same result for any number
// of threads. Owner thread only; the map may be read by others.
class MapWarp {
  public:
    // Blocks that are doubtful can be moved by the mean of the shifts that are like the first one:
    // where parts of the map come to lie on each other, that of the oldest part.
    enum class Doubtful { kLeftOut, kMoved };
    // `map` outlives the object and stays as it is. `motions`: by BlockId. Blocks in which shifts
    // differ by more than this standard deviation are doubtful. Blocks outside the box, and those
    // without surface, are dropped. Exact to first order in the differences of shifts, which are
    // interpolated between blocks; a shift by whole voxels copies them.
    MapWarp(const BlockMap& map, const std::vector<BlockMotion>& motions, const WorldBox& box,
            double most_spread_m, Doubtful doubtful = Doubtful::kLeftOut);

    // See BlockMover.
    bool Step();
    // After that, once.
    WarpedMap Take() { return std::move(warped_); }

  private:
    WarpedMap warped_;
    std::unique_ptr<BlockMover> mover_, rough_mover_;  // the latter null if the map is whole
};

}  // namespace tessera
