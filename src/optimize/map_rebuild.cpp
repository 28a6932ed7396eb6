#include "optimize/map_rebuild.h"

#include <algorithm>

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
    made_ = true;
    doubtful_ = std::move(doubtful);
}

void MapRebuild::BeginFusion(WarpedMap moved) {
    if (moved.whole) {
        map_ = std::move(moved.map);
        doubtful_ = std::move(moved.doubtful);
        return;
    }
    moved_ = std::move(moved.map);
    rough_ = std::move(moved.rough);
    if (moved_->has_labels()) map_->EnableLabels();
    for (const BlockCoord& c : moved.doubtful) {
        const BlockId id = map_->Allocate(c);
        if (id == kUnknownBlock) break;  // the map is full
        if (map_->has_labels())
            std::copy_n(rough_->label(rough_->Find(c)), kBlockVoxels, map_->label(id));
    }
}

Result<bool> MapRebuild::Step(FrameStore& store, int frames) {
    if (warp_) {
        if (!warp_->Step()) return false;
        BeginFusion(warp_->Take());
        warp_.reset();
    }
    if (made_ || copy_) return true;  // the map is whole
    const std::vector<StoredFrame>& stored = store.frames();
    auto next = std::ranges::lower_bound(stored, next_ordinal_, {}, &StoredFrame::ordinal);
    for (int i = 0; i < frames && next != stored.end(); ++i, ++next) {
        next_ordinal_ = next->ordinal + 1;
        const auto keyframe = static_cast<std::size_t>(next->keyframe);
        if (keyframe < left_out_.size() && left_out_[keyframe]) continue;
        if (moved_ &&
            !MaySee(*map_, camera_, PoseOf(*next), static_cast<float>(preparation_.max_depth_m)))
            continue;
        // Skips a frame that cannot be loaded.
        if (!store.LoadPrepared(*next, camera_, preparation_, frame_, prepared_).ok()) continue;
        if (Status status = Fuse(*next); !status.ok()) return status;
    }
    const bool done = next == stored.end();
    if (done && moved_) AddToTheMoved();
    if (done && pager_)
        if (Status status = pager_->Complete(*map_); !status.ok()) return status;
    return done;
}

int MapRebuild::Left(const FrameStore& store) const {
    const std::vector<StoredFrame>& stored = store.frames();
    return static_cast<int>(
        stored.end() - std::ranges::lower_bound(stored, next_ordinal_, {}, &StoredFrame::ordinal));
}

// Takes over the blocks fused again that have a surface; the frames saw the rest empty. What they
// did not see stays as it was moved: a busy live run does not store all frames.
void MapRebuild::AddToTheMoved() {
    for (BlockId id = 1; id < map_->size(); ++id) {
        const BlockMap* from = map_.get();
        BlockId block = id;
        if (std::none_of(map_->field(id), map_->field(id) + kBlockVoxels, HasDistance)) {
            from = rough_.get();
            block = rough_->Find(map_->coord(id));
        }
        if (!HasSurface(from->field(block), from->config())) continue;
        const BlockId to = moved_->Allocate(map_->coord(id));
        if (to == kUnknownBlock) break;  // the map is full
        std::copy_n(from->field(block), kBlockVoxels, moved_->field(to));
        std::copy_n(from->weight(block), kBlockVoxels, moved_->weight(to));
        std::copy_n(from->colour(block), kBlockVoxels, moved_->colour(to));
        if (moved_->has_labels()) std::copy_n(from->label(block), kBlockVoxels, moved_->label(to));
    }
    map_ = std::move(moved_);
    rough_.reset();
}

// Fuses the loaded frame.
Status MapRebuild::Fuse(const StoredFrame& stored) {
    Integrator::View view = stored.view;
    view.T_world_camera = PoseOf(stored);
    if (moved_) {
        integrator_.Integrate(prepared_, view, *map_, Integrator::Blocks::kExisting);
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

}  // namespace tessera
