// Makes the map that belongs to corrected keyframe poses, step by step, while the old map stays in
// use: from all stored frames, which equals a fresh fusion with the new poses, or by moving the map
// in use.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mapping/integrator.h"
#include "optimize/field_check.h"
#include "optimize/frame_store.h"
#include "optimize/map_pager.h"
#include "optimize/map_warp.h"
#include "semantics/label_mapper.h"

namespace tessera {

// Owner thread only.
class MapRebuild {
  public:
    // `T_world_keyframe`: by keyframe; add later keyframes with AddKeyframe. `labels`: a new mapper
    // that receives the frames' detections; may be null. `pager`: if given, holds part of the map.
    MapRebuild(const FieldSettings& settings, std::vector<Eigen::Isometry3d> T_world_keyframe,
               std::unique_ptr<LabelMapper> labels, std::unique_ptr<MapPager> pager = nullptr);

    // Moves the map in use, with all frames and labels. Blocks that the warp leaves out are fused
    // again. Without pager.
    MapRebuild(const FieldSettings& settings, std::vector<Eigen::Isometry3d> T_world_keyframe,
               MapWarp warp);

    // With a map that is made already. `doubtful`: see TakeDoubtful.
    MapRebuild(const FieldSettings& settings, std::vector<Eigen::Isometry3d> T_world_keyframe,
               std::unique_ptr<BlockMap> made, std::vector<BlockCoord> doubtful);

    void AddKeyframe(const Eigen::Isometry3d& T_world_keyframe) {
        T_world_keyframe_.push_back(T_world_keyframe);
    }
    const std::vector<Eigen::Isometry3d>& T_world_keyframe() const { return T_world_keyframe_; }

    // Moves some blocks, or fuses at most `frames` more. Returns true if none is left and the map
    // can be taken. Errors come from the pager; after one the map must not be used.
    Result<bool> Step(FrameStore& store, int frames);
    // Frames that are not fused yet.
    int Left(const FrameStore& store) const;
    // Frames of these keyframes are not fused. `left_out`: by keyframe; empty: none.
    void LeaveOut(std::vector<bool> left_out) { left_out_ = std::move(left_out); }
    // Keeps the warp's map, a copy of the one in use, which goes on.
    void Keep(std::unique_ptr<BlockMap> copy) { copy_ = std::move(copy); }
    bool has_copy() const { return copy_ != nullptr; }
    // From no other map, and without a pager, which may fail.
    bool fuses_all() const { return !warp_ && !again_ && !whole_ && !pager_; }
    // Blocks of the map that were moved although keyframes disagree about them.
    std::vector<BlockCoord> TakeDoubtful() { return std::move(doubtful_); }
    std::unique_ptr<BlockMap> TakeMap() { return std::move(map_); }
    std::unique_ptr<LabelMapper> TakeLabels() { return std::move(labels_); }
    std::unique_ptr<MapPager> TakePager() { return std::move(pager_); }

  private:
    Eigen::Isometry3d PoseOf(const StoredFrame& stored) const {
        return T_world_keyframe_[static_cast<std::size_t>(stored.keyframe)] *
               stored.T_keyframe_camera;
    }
    void UseMoved(WarpedMap moved);
    Result<bool> FuseNext(FrameStore& store, int frames);
    bool Wants(const StoredFrame& stored) const;
    Status Fuse(const StoredFrame& stored);
    void AddFusedAgain();

    std::unique_ptr<BlockMap> map_;   // what is made
    bool whole_ = false;              // nothing has to be fused
    std::unique_ptr<BlockMap> copy_;  // see Keep
    std::optional<MapWarp> warp_;     // moves the map in use; empty once it is moved
    // Of a map that was moved: the blocks that are fused again, and `rough` of WarpedMap. Else
    // null.
    std::unique_ptr<BlockMap> again_, rough_;
    std::vector<BlockCoord> doubtful_;
    std::vector<bool> left_out_;
    Integrator integrator_;
    PinholeCamera camera_;
    PreparedFrame::Config preparation_;
    std::vector<Eigen::Isometry3d> T_world_keyframe_;
    std::unique_ptr<LabelMapper> labels_;
    std::unique_ptr<MapPager> pager_;
    std::int64_t next_ordinal_ = 0;
    Frame frame_;
    PreparedFrame prepared_;
};

}  // namespace tessera
