// Makes the map that a corrected pose graph asks for, step by step, while the old one is in use:
// from the stored frames, or by moving the map in use.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "optimize/frame_store.h"
#include "optimize/map_rebuild.h"
#include "optimize/scan_graph.h"

namespace tessera {

// Owner thread only.
class MapCorrector {
  public:
    // Labelling settings and classes, if objects are labelled.
    struct Labels {
        LabelConfig config;
        LabelClasses classes;
    };
    // Makes a pager that keeps a corrected map within a memory limit. Empty: no paging.
    using MakePager = std::function<Result<std::unique_ptr<MapPager>>()>;

    // All references outlive the corrector.
    MapCorrector(const FieldSettings& settings, const ScanGraph& graph, FrameStore& store,
                 std::optional<Labels> labels, MakePager make_pager)
        : settings_(settings),
          graph_(graph),
          store_(store),
          labels_(std::move(labels)),
          make_pager_(std::move(make_pager)) {}

    // Maps that are begun from now on have labels.
    void EnableLabels(Labels labels) { labels_ = std::move(labels); }
    const std::optional<Labels>& labels() const { return labels_; }

    bool busy() const { return made_ != nullptr; }
    // A copy of the map in use is being moved.
    bool moves_copy() const { return made_ && made_->has_copy(); }
    // All frames are fused again, and nothing can stop that.
    bool FusesAll() const { return made_ && made_->fuses_all(); }
    // Of the map that is being made, by keyframe. Only while busy.
    const std::vector<Eigen::Isometry3d>& T_new_keyframe() const {
        return made_->T_world_keyframe();
    }
    // True if a map is due and the one in use can be moved while it goes on being used.
    bool WantsMap() const;
    // Surfaces closer than that are one surface to tracking.
    double OneSurface_m() const;
    // False if labels move far, with a pager, or if there is too little memory for two more maps.
    bool MayMove(const BlockMap& in_use) const;
    // Moves a copy of the map in use. Blocks about which keyframes disagree are moved as well as
    // possible, and fused again at the end of the run. If null, or if it may not be moved, all
    // frames are fused again.
    void Move(std::unique_ptr<BlockMap> copy);

    // Returns true if a map is being made, or was begun because the one in use is off by at least
    // the tolerance. `in_use`: if given, it is moved, and blocks about which keyframes disagree are
    // fused again; it stays as it is until the map is made.
    bool Begin(double tolerance_m, const BlockMap* in_use = nullptr,
               MapWarp::Doubtful doubtful = MapWarp::Doubtful::kLeftOut);
    // Moves the parts of the map in use as the graph joins them, and removes those that are left
    // out. Only if MayMove holds, and without labels.
    void BeginParts(const BlockMap& in_use);
    // For each keyframe that is added to the graph. The map that is being made has it at the same
    // place relative to the one before as the graph.
    void AddKeyframe();
    // Moves some blocks, or fuses at most this many frames. Returns what was made once it is done.
    std::unique_ptr<MapRebuild> Step(int frames);
    void Discard() { made_.reset(); }
    // Discards a map for poses that are outdated by at least the tolerance, or that lacks what has
    // changed since.
    void DiscardOutdated(double tolerance_m);

    // Blocks of the map in use were moved although keyframes disagree about them.
    bool doubtful() const { return !doubtful_.empty(); }
    // Returns once why the map is no longer corrected; usually empty.
    std::string TakeTrouble() { return std::exchange(trouble_, {}); }

  private:
    void BeginMoved(const BlockMap& in_use, MapWarp::Doubtful doubtful);
    void Stop(const Status& why);

    const FieldSettings& settings_;
    const ScanGraph& graph_;
    FrameStore& store_;
    std::optional<Labels> labels_;
    MakePager make_pager_;
    std::unique_ptr<MapRebuild> made_;  // null if the map in use is up to date
    std::vector<BlockCoord> doubtful_;
    bool broken_ = false;  // no further map can be made
    std::string trouble_;
};

}  // namespace tessera
