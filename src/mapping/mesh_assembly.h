// Joins block meshes into one mesh with shared vertices.
#pragma once

#include <memory>
#include <vector>

#include "core/mesh.h"
#include "mapping/block_mesh.h"

namespace tessera {

// `blocks` by block id, null where there is no surface. Triangles whose vertex the neighbour does
// not have (it was meshed at another time) are left out, and so are connected pieces of fewer than
// `min_component_triangles`. `labels`: of the blocks' vertices, a block's may be empty: none has
// one; or empty as a whole: the mesh has no labels.
using BlockVertexLabels = std::vector<std::vector<VertexLabel>>;
TriangleMesh AssembleMesh(const std::vector<std::unique_ptr<const BlockMesh>>& blocks,
                          double voxel_size_m, int min_component_triangles,
                          const BlockVertexLabels& labels = {});

}  // namespace tessera
