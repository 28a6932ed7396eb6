#include "optimize/part_motion.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/se3.h"
#include "mapping/map_delta.h"
#include "optimize/block_mover.h"

namespace tessera {
namespace {

// Removes the blocks of parts that are left out.
void RemoveLeftOut(const ScanGraph& graph, BlockMap& map) {
    std::vector<Eigen::Isometry3d> T_map_removed;  // a keyframe of each part
    for (const Keyframe& keyframe : graph.keyframes().all())
        if (graph.LeftOut(keyframe.id) &&
            std::ranges::none_of(T_map_removed, [&](const Eigen::Isometry3d& T) {
                return InOnePart(T, keyframe.T_map_camera);
            }))
            T_map_removed.push_back(keyframe.T_map_camera);
    for (BlockId id = 1; id < map.size(); ++id)
        if (!map.IsFree(id) && std::ranges::any_of(T_map_removed, [&](const Eigen::Isometry3d& T) {
                return InOnePart(T, PlaceOf(map, id));
            }))
            map.Release(id);
}

}  // namespace

MovedParts MoveParts(const BlockMap& in_use, const ScanGraph& graph, const WorldBox& box) {
    const std::vector<Eigen::Isometry3d> to = graph.Poses();
    MovedParts moved{CopyLayers(in_use, BlockMap::Layers::kAll), graph.MapPoses(), {}};
    RemoveLeftOut(graph, *moved.map);
    for (std::size_t k = 0; k < to.size(); ++k) {
        if (graph.LeftOut(static_cast<int>(k)) || InOnePart(moved.T_map_keyframe[k], to[k]))
            continue;
        const Eigen::Isometry3d T_old = moved.T_map_keyframe[k],
                                T_new_old = Normalised(to[k] * T_old.inverse());
        for (Eigen::Isometry3d& T : moved.T_map_keyframe)
            if (InOnePart(T, T_old)) T = Normalised(T_new_old * T);
        std::vector<BlockId> blocks;
        for (BlockId id = 1; id < in_use.size(); ++id) {
            if (in_use.IsFree(id) || !InOnePart(PlaceOf(in_use, id), T_old)) continue;
            blocks.push_back(id);
            moved.map->Release(id);
        }
        BlockMover mover = MoveRigidly(in_use, blocks, T_new_old, box);
        while (!mover.Step(*moved.map, 0)) continue;
        const std::set<BlockId> added(mover.added().begin(), mover.added().end());
        for (const BlockId id : mover.moved())
            if (!added.contains(id)) moved.doubtful.push_back(moved.map->coord(id));
    }
    for (std::size_t k = 0; k < to.size(); ++k)
        if (graph.LeftOut(static_cast<int>(k))) moved.T_map_keyframe[k] = to[k];
    moved.map->NumberAnew();  // a scan file wants no gaps
    for (BlockId id = 1; id < moved.map->size(); ++id) moved.map->MarkChanged(id, 0);
    return moved;
}

}  // namespace tessera
