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

// The blocks of `to` in which the voxels of a block are once it has moved.
void AppendLandings(const BlockCoord& c, const Eigen::Isometry3d& T_new_old, const BlockMap& to,
                    std::vector<BlockCoord>& landings) {
    Eigen::Isometry3d T = T_new_old;
    T.translation() /= to.config().voxel_size_m;
    const Eigen::Vector3d corner = kBlockSide * Eigen::Vector3d(c.x, c.y, c.z);
    const Eigen::AlignedBox3d voxels =
        Eigen::AlignedBox3d(corner, corner + Eigen::Vector3d::Constant(kBlockSide - 1))
            .transformed(T);
    const auto block_of = [](const Eigen::Vector3d& voxel) -> Eigen::Vector3i {
        return ((voxel.array() + 0.5).floor() / kBlockSide).floor().cast<int>();
    };
    const Eigen::Vector3i first = block_of(voxels.min()), last = block_of(voxels.max());
    for (int z = first.z(); z <= last.z(); ++z)
        for (int y = first.y(); y <= last.y(); ++y)
            for (int x = first.x(); x <= last.x(); ++x)
                if (to.Find({x, y, z}) != kUnknownBlock) landings.push_back({x, y, z});
}

}  // namespace

MovedParts MoveParts(const BlockMap& in_use, const ScanGraph& graph, const WorldBox& box,
                     std::span<const BlockCoord> doubtful) {
    const std::vector<Eigen::Isometry3d> to = graph.Poses();
    MovedParts moved{CopyLayers(in_use, BlockMap::Layers::kAll), graph.MapPoses(), {}};
    RemoveLeftOut(graph, *moved.map);
    std::vector<BlockCoord> stay;
    for (const BlockCoord& c : doubtful)
        if (moved.map->Find(c) != kUnknownBlock) stay.push_back(c);
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
        const auto moves = std::stable_partition(
            stay.begin(), stay.end(),
            [&](const BlockCoord& c) { return !InOnePart(PlaceOf(c, in_use.config()), T_old); });
        for (auto c = moves; c != stay.end(); ++c)
            AppendLandings(*c, T_new_old, *moved.map, moved.doubtful);
        stay.erase(moves, stay.end());
    }
    moved.doubtful.insert(moved.doubtful.end(), stay.begin(), stay.end());
    for (std::size_t k = 0; k < to.size(); ++k)
        if (graph.LeftOut(static_cast<int>(k))) moved.T_map_keyframe[k] = to[k];
    moved.map->NumberAnew();  // a scan file wants no gaps
    for (BlockId id = 1; id < moved.map->size(); ++id) moved.map->MarkChanged(id, 0);
    return moved;
}

}  // namespace tessera
