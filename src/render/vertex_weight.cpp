#include "render/vertex_weight.h"

#include <algorithm>
#include <cmath>

namespace tessera {

float VertexWeight(const BlockMap& map, const BlockMesh& owner, const BlockMesh::Vertex& vertex) {
    const int offset = vertex.edge % kBlockVoxels, axis = vertex.edge / kBlockVoxels;
    const int stride = 1 << 3 * axis;
    const bool leaves = (offset / stride) % kBlockSide == kBlockSide - 1;
    const BlockId next = owner.blocks[leaves ? std::size_t{1} << axis : 0];
    const int next_offset = leaves ? offset - (kBlockSide - 1) * stride : offset + stride;
    const float lower = map.weight(owner.blocks[0])[offset], upper = map.weight(next)[next_offset];
    const float part = static_cast<float>(vertex.fraction) / 65536;
    return ((1 - part) * lower + part * upper) / kWeightSteps;
}

std::uint8_t WeightStep(float weight) {
    const float steps = 255.0f / 8 * std::log2(1 + std::clamp(weight, 0.0f, kMaxWeight));
    return static_cast<std::uint8_t>(std::lround(steps));
}

}  // namespace tessera
