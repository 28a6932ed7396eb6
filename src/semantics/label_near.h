// A map's label at a point.
#pragma once

#include <Eigen/Core>

#include "mapping/block_map.h"

namespace tessera {

// The nearest voxel's label; where that has none, of the next one along the axis on which the point
// lies between two. Metres, world frame. Thread-safe while nobody writes the map.
VoxelLabel LabelNear(const BlockMap& map, const Eigen::Vector3d& p_world);

}  // namespace tessera
