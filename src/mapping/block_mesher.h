// Interface for meshing blocks outside the CPU, on a device that holds the map.
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

    // Stores the result of MeshBlock for each of the blocks under its id. None of the blocks may be
    // free. Reads voxels only from the device's copy of the map. Returns false if the device has no
    // room; some blocks may then be stored already.
    [[nodiscard]] virtual bool MeshBlocks(const BlockMap& map, std::span<const BlockId> blocks,
                                          double min_weight, BlockMeshes& meshes) = 0;
};

}  // namespace tessera
