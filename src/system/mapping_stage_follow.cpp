// MappingStage: a corrected map takes over what was fused while it was made.
#include <algorithm>
#include <utility>

#include "mapping/map_copier.h"
#include "system/mapping_stage.h"

namespace tessera {

void MappingStage::ReplaceMoved(std::unique_ptr<BlockMap> map, const Eigen::Isometry3d& T_new_old,
                                std::uint32_t moved_at) {
    constexpr int kStepsAtOnce = 4;
    std::vector<BlockId> changed = ChangedSince(*map_, moved_at);
    const auto is_new = [&](BlockId id) { return map->Find(map_->coord(id)) == kUnknownBlock; };
    const auto old = std::stable_partition(changed.begin(), changed.end(), is_new);
    const auto latest_first = [&](BlockId a, BlockId b) {
        return map_->revision(a) > map_->revision(b);
    };
    std::stable_sort(changed.begin(), old, latest_first);
    std::stable_sort(old, changed.end(), latest_first);
    BlockMover mover = MoveRigidly(*map_, changed, T_new_old, config_.fusion.volume.box());
    std::unique_ptr<BlockMap> from = std::exchange(map_, nullptr);
    Replace(std::move(map), nullptr);
    following_.emplace(Following{std::move(from), std::move(mover), integrator_->revision()});
    for (int i = 0; i < kStepsAtOnce && following_; ++i) Follow();
}

void MappingStage::Follow() {
    Following& f = *following_;
    const bool done = f.mover.Step(*map_, f.replaced_at);
    const std::span<const BlockId> added = std::span(f.mover.added()).subspan(f.added),
                                   moved = std::span(f.mover.moved()).subspan(f.moved);
    integrator_->MarkChanged(*map_, moved);
    AddChanges(added, moved);
    f.added += added.size();
    f.moved += moved.size();
    if (done) following_.reset();
}

}  // namespace tessera
