// Where blocks are meshed, if not by the processor: on a device that keeps the map.
#pragma once

#include <span>

#include "mapping/block_mesh.h"

namespace tessera {

// By block id; null where there is no surface.
using BlockMeshes = std::vector<std::unique_ptr<const BlockMesh>>;

// Owner thread only.
class BlockMesher {
  public:
    virtual ~BlockMesher() = default;

    // Puts what MeshBlock makes of each of the blocks, none of them free, under its id; of the
    // map's voxels only the device's are read. False: no room for it there, and only some of them
    // were put.
    [[nodiscard]] virtual bool MeshBlocks(const BlockMap& map, std::span<const BlockId> blocks,
                                          double min_weight, BlockMeshes& meshes) = 0;
};

}  // namespace tessera
