#include "system/rebuild_paging.h"

#include <algorithm>

#include "core/check.h"

namespace tessera {

RebuildPaging::RebuildPaging(const PipelineConfig& config, const PinholeCamera& camera,
                             std::shared_ptr<CubeScratch> store)
    : limit_bytes_(config.memory_limit_mb * 1e6),
      viewed_(config, camera),
      store_(std::move(store)) {}

Status RebuildPaging::Bring(const Eigen::Isometry3d& T_world_camera, BlockMap& map,
                            LabelMapper* labels) {
    const auto [first, last] = viewed_.Around(T_world_camera, 0);
    std::vector<BlockId> ids;
    for (int z = first.z; z <= last.z && !away_.empty(); ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const auto cube = away_.find(CubeKey({x, y, z}));
                if (cube == away_.end() || viewed_.Outside_m(T_world_camera, {x, y, z}) > 0)
                    continue;
                if (Status status = store_->Read(cube->first, copies_); !status.ok()) return status;
                ids.clear();
                for (std::size_t i = 0; i < copies_.size(); ++i) {
                    ids.push_back(map.Allocate(copies_.coords[i], copies_.numbers[i]));
                    TESSERA_CHECK(ids.back() != kUnknownBlock,
                                  "no room for a block that was in the map before");
                    copies_.Put(i, map, ids.back());
                }
                if (labels != nullptr) labels->Return(map, ids);
                away_.erase(cube);
            }
    return Status::Ok();
}

// Skips a cube that has not changed since it was loaded: a loaded block has revision 0 until it is
// fused into. Label changes do not change the revision, so a map with labels is always stored.
Status RebuildPaging::Store(const BlockMap& map, const ResidentCubes::Cube& cube) {
    const std::span<const BlockId> blocks = resident_.blocks(cube);
    const std::int64_t key = CubeKey(cube.cube);
    const bool as_stored =
        !map.has_labels() && store_->Count(key) == static_cast<std::int32_t>(blocks.size()) &&
        std::ranges::all_of(blocks, [&](BlockId id) { return map.revision(id) == 0; });
    if (as_stored) return Status::Ok();
    copies_.Copy(map, blocks);
    return store_->Put(key, copies_);
}

Status RebuildPaging::Release(const Eigen::Isometry3d& T_world_camera, BlockMap& map,
                              LabelMapper* labels) {
    if (static_cast<double>(map.bytes()) <= limit_bytes_) return Status::Ok();
    resident_.Gather(map);
    for (const ResidentCubes::Cube& cube : resident_.Farthest(viewed_, T_world_camera)) {
        if (static_cast<double>(map.bytes()) <= kRefill * limit_bytes_) break;
        if (Status status = Store(map, cube); !status.ok()) return status;
        const std::span<const BlockId> blocks = resident_.blocks(cube);
        if (labels != nullptr) labels->Leave(map, blocks, {});
        for (const BlockId id : blocks) map.Release(id);
        away_[CubeKey(cube.cube)] = static_cast<std::int32_t>(blocks.size());
        paged_ = true;
    }
    return Status::Ok();
}

Status RebuildPaging::Complete(const BlockMap& map) {
    resident_.Gather(map);
    for (const ResidentCubes::Cube& cube : resident_.All())
        if (Status status = Store(map, cube); !status.ok()) return status;
    return Status::Ok();
}

MakeMapPager RebuildPagers(const PipelineConfig& config, const PinholeCamera& camera,
                           const std::string& scan_path) {
    return [config, camera, scan_path]() -> Result<std::unique_ptr<MapPager>> {
        Result<std::shared_ptr<CubeScratch>> store = CubeScratch::Create(scan_path);
        if (!store.ok()) return store.status();
        return std::unique_ptr<MapPager>(
            std::make_unique<RebuildPaging>(config, camera, std::move(store.value())));
    };
}

}  // namespace tessera
