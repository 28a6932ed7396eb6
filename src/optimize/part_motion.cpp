#include "optimize/part_motion.h"

#include <set>
#include <utility>

#include "core/se3.h"
#include "mapping/map_delta.h"
#include "optimize/block_mover.h"

namespace tessera {

MovedParts MoveParts(const BlockMap& in_use, const ScanGraph& graph, const WorldBox& box) {
    const double block_m = kBlockSide * in_use.config().voxel_size_m;
    const auto in_part = [&](BlockId id, const Eigen::Isometry3d& T_map_camera) {
        const BlockCoord c = in_use.coord(id);
        return InOnePart(
            Eigen::Isometry3d(Eigen::Translation3d(block_m * Eigen::Vector3d(c.x, c.y, c.z))),
            T_map_camera);
    };
    const std::vector<Eigen::Isometry3d> to = graph.Poses();
    MovedParts moved{CopyLayers(in_use, BlockMap::Layers::kAll), graph.MapPoses(), {}};
    for (std::size_t k = 0; k < to.size(); ++k) {
        if (InOnePart(moved.T_map_keyframe[k], to[k])) continue;
        const Eigen::Isometry3d T_old = moved.T_map_keyframe[k],
                                T_new_old = Normalised(to[k] * T_old.inverse());
        for (Eigen::Isometry3d& T : moved.T_map_keyframe)
            if (InOnePart(T, T_old)) T = Normalised(T_new_old * T);
        std::vector<BlockId> blocks;
        for (BlockId id = 1; id < in_use.size(); ++id) {
            if (in_use.IsFree(id) || !in_part(id, T_old)) continue;
            blocks.push_back(id);
            moved.map->Release(id);
        }
        BlockMover mover = MoveRigidly(in_use, blocks, T_new_old, box);
        while (!mover.Step(*moved.map, 0)) continue;
        const std::set<BlockId> added(mover.added().begin(), mover.added().end());
        for (const BlockId id : mover.moved())
            if (!added.contains(id)) moved.doubtful.push_back(moved.map->coord(id));
    }
    for (BlockId id = 1; id < moved.map->size(); ++id) moved.map->MarkChanged(id, 0);
    return moved;
}

}  // namespace tessera
