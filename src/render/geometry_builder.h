// From what a mesher meshed anew to the blocks that whoever keeps a copy of the mesh must replace:
// the predicted view's store on the graphics card, and a person's window.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapping/mesher.h"
#include "render/block_geometry.h"

namespace tessera {

// Owner thread only.
class GeometryBuilder {
  public:
    // What the mesher's last Update(map) meshed and the lower neighbours, which hold copies of its
    // vertices; to be called after each Update whose changes matter. Works on all of TBB's threads;
    // the same bytes for any number of them. The blocks live until the next call; the caller may
    // move them away.
    std::span<GeometryBlock> Build(const BlockMap& map, const Mesher& mesher,
                                   const MarkVertex& mark = {});

    // What `mark` says of these blocks' voxels has changed, though the surface has not: the next
    // Build takes along every block with a vertex between two voxels of which one is theirs, its
    // own or borrowed.
    void MarkAgain(std::span<const BlockId> blocks) {
        remarked_.insert(remarked_.end(), blocks.begin(), blocks.end());
    }
    // Forgets what waits; to be called when the mesher was cleared.
    void Clear() { remarked_.clear(); }

  private:
    void FindStale(const BlockMap& map, const Mesher& mesher);

    std::vector<BlockId> remarked_;
    std::vector<BlockId> stale_;
    std::vector<std::uint8_t> is_stale_;  // by block id; all 0 between calls
    std::vector<GeometryBlock> blocks_;   // kept for their storage
};

}  // namespace tessera
