// Meshes blocks: on the CPU, or on a device that holds the map.
#pragma once

#include <span>

#include "mapping/block_mesh.h"

namespace tessera {

// Indexed by block id; null where there is no surface.
using BlockMeshes = std::vector<std::unique_ptr<const BlockMesh>>;

// Owner thread only.
class BlockMesher {
  public:
    virtual ~BlockMesher() = default;

    // Stores the result of MeshBlock for each of the blocks under its id; null if it is free. A
    // device reads its own copy of the map, and none of the blocks may be free. Returns false if
    // the device has no room; some blocks may then be stored already.
    [[nodiscard]] virtual bool MeshBlocks(const BlockMap& map, std::span<const BlockId> blocks,
                                          double min_weight, BlockMeshes& meshes) = 0;
};

class CpuBlockMesher : public BlockMesher {
  public:
    [[nodiscard]] bool MeshBlocks(const BlockMap& map, std::span<const BlockId> blocks,
                                  double min_weight, BlockMeshes& meshes) override;
};

}  // namespace tessera
