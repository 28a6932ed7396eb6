// Joins block meshes into one mesh with shared vertices.
#pragma once

#include <memory>
#include <vector>

#include "core/mesh.h"
#include "mapping/block_mesh.h"

namespace tessera {

// `blocks` is indexed by block id, null where there is no surface. Drops triangles whose vertex is
// missing in the neighbour (it was meshed at another time), and connected components of fewer than
// `min_component_triangles`. `labels` holds the labels of each block's vertices. An empty entry
// means that the block has none; if `labels` is empty, the mesh has no labels.
using BlockVertexLabels = std::vector<std::vector<VertexLabel>>;
TriangleMesh AssembleMesh(const std::vector<std::unique_ptr<const BlockMesh>>& blocks,
                          double voxel_size_m, int min_component_triangles,
                          const BlockVertexLabels& labels = {});

}  // namespace tessera
