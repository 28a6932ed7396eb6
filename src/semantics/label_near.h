// Looks up the map's label at a point.
#pragma once

#include <Eigen/Core>

#include "mapping/block_mesh.h"

namespace tessera {

struct KnownBlock {
    BlockCoord coord;
    BlockId id = kUnknownBlock;  // where the map has it now; kUnknownBlock if it does not
};

// Returns the label of the nearest voxel. If that has no votes, returns the label of the next voxel
// along the axis on which the point lies farthest from the voxel centre. Metres, world frame.
// Thread-safe while no other thread writes to the map.
VoxelLabel LabelNear(const BlockMap& map, const Eigen::Vector3d& p_world);

// The same, for many points near the block `known`, which is not searched for again.
VoxelLabel LabelNear(const BlockMap& map, const KnownBlock& known, const Eigen::Vector3d& p_world);

// The same at a vertex of `owner`, which was meshed from the map as it is now. Needs no search for
// the block.
VoxelLabel LabelNear(const BlockMap& map, const BlockMesh& owner, const BlockMesh::Vertex& vertex);

}  // namespace tessera
