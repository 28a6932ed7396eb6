// Builds the blocks that holders of a mesh copy must replace after an update of the mesher: the
// predicted view's store on the GPU, and the viewer window.
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
    // Builds the blocks that the mesher's last Update(map) meshed, and their lower neighbours,
    // which hold copies of their vertices. Call this after each Update whose changes matter. Runs
    // on all TBB threads and gives the same bytes for any number of them. The blocks live until the
    // next call; the caller may move them away.
    std::span<GeometryBlock> Build(const BlockMap& map, const Mesher& mesher,
                                   const MarkVertex& mark = {});

    // Call this when the marks of these blocks' voxels have changed but the surface has not. The
    // next Build includes every block with a vertex, its own or borrowed, that lies next to a voxel
    // of these blocks.
    void MarkAgain(std::span<const BlockId> blocks) {
        remarked_.insert(remarked_.end(), blocks.begin(), blocks.end());
    }
    // Forgets pending blocks. Call this when the mesher is cleared.
    void Clear() { remarked_.clear(); }

  private:
    void FindStale(const BlockMap& map, const Mesher& mesher);

    std::vector<BlockId> remarked_;
    std::vector<BlockId> stale_;
    std::vector<std::uint8_t> is_stale_;  // indexed by block id; all 0 between calls
    std::vector<GeometryBlock> blocks_;   // kept to reuse their storage
};

}  // namespace tessera
