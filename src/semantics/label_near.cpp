#include "semantics/label_near.h"

namespace tessera {
namespace {

const VoxelLabel* VoxelAt(const BlockMap& map, const KnownBlock* known,
                          const Eigen::Array3i& voxel) {
    const BlockCoord coord{voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3};
    const BlockId id = known != nullptr && known->coord == coord ? known->id : map.Find(coord);
    if (id == kUnknownBlock) return nullptr;
    return map.label(id) + (voxel.x() & 7) + 8 * (voxel.y() & 7) + 64 * (voxel.z() & 7);
}

VoxelLabel LabelNearPoint(const BlockMap& map, const KnownBlock* known,
                          const Eigen::Vector3d& p_world) {
    const Eigen::Array3d at = p_world.array() / map.config().voxel_size_m;
    const Eigen::Array3i nearest = at.round().cast<int>();
    const VoxelLabel* label = VoxelAt(map, known, nearest);
    if (label != nullptr && label->count[0] > 0) return *label;
    int axis = 0;
    const Eigen::Array3d rest = at - nearest.cast<double>();
    rest.abs().maxCoeff(&axis);
    Eigen::Array3i next = nearest;
    next[axis] += rest[axis] > 0 ? 1 : -1;
    label = VoxelAt(map, known, next);
    return label != nullptr ? *label : VoxelLabel{};
}

}  // namespace

VoxelLabel LabelNear(const BlockMap& map, const Eigen::Vector3d& p_world) {
    return LabelNearPoint(map, nullptr, p_world);
}

VoxelLabel LabelNear(const BlockMap& map, const KnownBlock& known, const Eigen::Vector3d& p_world) {
    return LabelNearPoint(map, &known, p_world);
}

VoxelLabel LabelNear(const BlockMap& map, const BlockMesh& owner, const BlockMesh::Vertex& vertex) {
    const int offset = vertex.edge % kBlockVoxels, axis = vertex.edge / kBlockVoxels;
    const int stride = 1 << 3 * axis;
    const bool leaves = (offset / stride) % kBlockSide == kBlockSide - 1;
    const BlockId next = owner.blocks[leaves ? std::size_t{1} << axis : 0];
    const VoxelLabel& lower = map.label(owner.blocks[0])[offset];
    const VoxelLabel& upper =
        map.label(next)[leaves ? offset - (kBlockSide - 1) * stride : offset + stride];
    const bool nearer_upper = vertex.fraction >= 1 << 15;
    const VoxelLabel &nearest = nearer_upper ? upper : lower, &other = nearer_upper ? lower : upper;
    return nearest.count[0] > 0 ? nearest : other;
}

}  // namespace tessera
