#include "optimize/map_rebuild.h"

#include <algorithm>
#include <utility>

namespace tessera {

MapRebuild::MapRebuild(const FieldSettings& settings,
                       std::vector<Eigen::Isometry3d> T_world_keyframe,
                       std::unique_ptr<LabelMapper> labels, std::unique_ptr<MapPager> pager)
    : map_(std::make_unique<BlockMap>(settings.map)),
      integrator_(settings.fusion, settings.camera),
      camera_(settings.camera),
      preparation_(settings.preparation),
      T_world_keyframe_(std::move(T_world_keyframe)),
      labels_(std::move(labels)),
      pager_(std::move(pager)) {
    if (labels_) map_->EnableLabels();
}

MapRebuild::MapRebuild(const FieldSettings& settings,
                       std::vector<Eigen::Isometry3d> T_world_keyframe, MapWarp warp)
    : MapRebuild(settings, std::move(T_world_keyframe), nullptr) {
    warp_.emplace(std::move(warp));
}

MapRebuild::MapRebuild(const FieldSettings& settings,
                       std::vector<Eigen::Isometry3d> T_world_keyframe,
                       std::unique_ptr<BlockMap> made, std::vector<BlockCoord> doubtful)
    : MapRebuild(settings, std::move(T_world_keyframe), nullptr) {
    map_ = std::move(made);
    whole_ = true;
    doubtful_ = std::move(doubtful);
}

Result<bool> MapRebuild::Step(FrameStore& store, int frames) {
    if (warp_) {
        if (!warp_->Step()) return false;
        UseMoved(warp_->Take());
        warp_.reset();
    }
    if (whole_) return true;
    const Result<bool> all_fused = FuseNext(store, frames);
    if (!all_fused.ok() || !all_fused.value()) return all_fused;
    if (again_) AddFusedAgain();
    if (pager_)
        if (Status status = pager_->Complete(*map_); !status.ok()) return status;
    return true;
}

// Takes over what was moved. The blocks that are left out of it are made ready to be fused again.
void MapRebuild::UseMoved(WarpedMap moved) {
    std::unique_ptr<BlockMap> none = std::exchange(map_, std::move(moved.map));
    whole_ = moved.whole;
    if (whole_) {
        doubtful_ = std::move(moved.doubtful);
        return;
    }
    again_ = std::move(none);
    rough_ = std::move(moved.rough);
    if (map_->has_labels()) again_->EnableLabels();
    for (const BlockCoord& c : moved.doubtful) {
        const BlockId id = again_->Allocate(c);
        if (id == kUnknownBlock) break;  // the map is full
        if (again_->has_labels())
            std::copy_n(rough_->label(rough_->Find(c)), kBlockVoxels, again_->label(id));
    }
}

// Returns true if none is left.
Result<bool> MapRebuild::FuseNext(FrameStore& store, int frames) {
    const std::vector<StoredFrame>& stored = store.frames();
    auto next = std::ranges::lower_bound(stored, next_ordinal_, {}, &StoredFrame::ordinal);
    for (int i = 0; i < frames && next != stored.end(); ++i, ++next) {
        next_ordinal_ = next->ordinal + 1;
        if (!Wants(*next)) continue;
        // Skips a frame that cannot be loaded.
        if (!store.LoadPrepared(*next, camera_, preparation_, frame_, prepared_).ok()) continue;
        if (Status status = Fuse(*next); !status.ok()) return status;
    }
    return next == stored.end();
}

bool MapRebuild::Wants(const StoredFrame& stored) const {
    const auto keyframe = static_cast<std::size_t>(stored.keyframe);
    if (keyframe < left_out_.size() && left_out_[keyframe]) return false;
    return !again_ ||
           MaySee(*again_, camera_, PoseOf(stored), static_cast<float>(preparation_.max_depth_m));
}

// Fuses the loaded frame.
Status MapRebuild::Fuse(const StoredFrame& stored) {
    Integrator::View view = stored.view;
    view.T_world_camera = PoseOf(stored);
    if (again_) {
        integrator_.Integrate(prepared_, view, *again_, Integrator::Blocks::kExisting);
        return Status::Ok();
    }
    if (pager_)
        if (Status status = pager_->Bring(view.T_world_camera, *map_, labels_.get()); !status.ok())
            return status;
    integrator_.Integrate(prepared_, view, *map_);
    if (labels_ && stored.detections) {
        labels_->Ignore(stored.detections->ignored());
        labels_->Label(stored.detections->Unpack(), frame_.depth_m, view.T_world_camera, *map_);
    }
    return pager_ ? pager_->Release(view.T_world_camera, *map_, labels_.get()) : Status::Ok();
}

// Takes over the blocks fused again that have a surface; the frames saw the rest empty. What they
// did not see stays as it was moved: a busy live run does not store all frames.
void MapRebuild::AddFusedAgain() {
    for (BlockId id = 1; id < again_->size(); ++id) {
        const BlockMap* from = again_.get();
        BlockId block = id;
        if (std::none_of(again_->field(id), again_->field(id) + kBlockVoxels, HasDistance)) {
            from = rough_.get();
            block = rough_->Find(again_->coord(id));
        }
        if (!HasSurface(from->field(block), from->config())) continue;
        const BlockId to = map_->Allocate(again_->coord(id));
        if (to == kUnknownBlock) break;  // the map is full
        std::copy_n(from->field(block), kBlockVoxels, map_->field(to));
        std::copy_n(from->weight(block), kBlockVoxels, map_->weight(to));
        std::copy_n(from->colour(block), kBlockVoxels, map_->colour(to));
        if (map_->has_labels()) std::copy_n(from->label(block), kBlockVoxels, map_->label(to));
    }
    again_.reset();
    rough_.reset();
}

int MapRebuild::Left(const FrameStore& store) const {
    const std::vector<StoredFrame>& stored = store.frames();
    return static_cast<int>(
        stored.end() - std::ranges::lower_bound(stored, next_ordinal_, {}, &StoredFrame::ordinal));
}

}  // namespace tessera
