// How often a vertex was measured, as the map's weights tell, for a person to see. Pure functions,
// thread-safe while nobody writes the map.
#pragma once

#include "mapping/block_mesh.h"

namespace tessera {

// Weight of the distance at a vertex of `owner`, which was meshed from `map`: between its two
// voxels' weights as the vertex lies between the voxels. [0, kMaxWeight].
float VertexWeight(const BlockMap& map, const BlockMesh& owner, const BlockMesh::Vertex& vertex);

// On a logarithmic scale, as one byte: round(255 log2(1 + weight) / 8); 0 is 0, kMaxWeight is 255.
std::uint8_t WeightStep(float weight);

}  // namespace tessera
