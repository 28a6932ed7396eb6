// How often a vertex was measured according to the map's weights, for display. Pure functions,
// thread-safe while nobody writes the map.
#pragma once

#include "mapping/block_mesh.h"

namespace tessera {

// Weight of the distance at a vertex of `owner`, which was meshed from `map`: interpolated between
// the weights of the vertex's two voxels. [0, kMaxWeight].
float VertexWeight(const BlockMap& map, const BlockMesh& owner, const BlockMesh::Vertex& vertex);

// Logarithmic scale in one byte: round(255 log2(1 + weight) / 8). 0 gives 0, kMaxWeight gives 255.
std::uint8_t WeightStep(float weight);

}  // namespace tessera
