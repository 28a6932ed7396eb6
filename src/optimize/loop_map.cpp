// Corrected maps of LoopCloser: when to build one, how to build it step by step, and the end of a
// run.
#include <algorithm>
#include <limits>
#include <utility>

#include "core/memory.h"
#include "core/se3.h"
#include "optimize/loop_closer.h"
#include "optimize/map_motion.h"
#include "optimize/map_warp.h"

namespace tessera {

// Largest displacement of any point within 2 m of a keyframe, between a map made with these
// keyframe poses and the pose graph.
double LoopCloser::MaxDisplacement_m(const std::vector<Eigen::Isometry3d>& T_map_keyframe) const {
    constexpr double kReach_m = 2.0;
    double farthest = 0;
    for (int i = 0; i < keyframes_.size(); ++i) {
        const Eigen::Isometry3d &map = T_map_keyframe[static_cast<std::size_t>(i)],
                                &graph = keyframes_[i].T_world_camera;
        farthest = std::max(farthest, (map.translation() - graph.translation()).norm() +
                                          kReach_m * RotationAngle(map, graph));
    }
    return farthest;
}

std::vector<Eigen::Isometry3d> LoopCloser::MapPoses() const {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < keyframes_.size(); ++i) poses.push_back(keyframes_[i].T_map_camera);
    return poses;
}

// An object that was seen at two places has two instances, which become one only by voting again.
// Unlike fusion, moving does not look at the free memory.
bool LoopCloser::MayMove(const BlockMap& in_use) const {
    if (make_pager_ || !MemoryHasRoomFor(in_use.bytes())) return false;
    return !labels_ ||
           (in_use.has_labels() && MaxDisplacement_m(MapPoses()) < settings_.map.truncation_m);
}

bool LoopCloser::WantsMap() const {
    return HasWork() && !rebuild_ && !broken_ && corrected_ && !make_pager_ && !labels_ &&
           MaxDisplacement_m(MapPoses()) >= settings_.map.truncation_m;
}

void LoopCloser::Move(std::unique_ptr<BlockMap> copy) {
    if (rebuild_) return;
    if (copy && !MayMove(*copy)) copy.reset();
    if (BeginRebuild(settings_.map.truncation_m, copy.get(), MapWarp::Doubtful::kMoved))
        rebuild_->Keep(std::move(copy));
}

// Returns true if a rebuild is in progress, or was started because the map is off by more than the
// tolerance. `in_use`: as in Finish; it stays as it is until the rebuild is done.
bool LoopCloser::BeginRebuild(double tolerance_m, const BlockMap* in_use,
                              MapWarp::Doubtful doubtful) {
    if (rebuild_) return true;
    if (broken_ || !corrected_) return false;
    std::vector<Eigen::Isometry3d> graph = GraphPoses();
    if (MaxDisplacement_m(MapPoses()) < tolerance_m) return false;
    if (in_use && PartsMove()) {
        rebuild_ = MoveParts(*in_use, graph);
        return true;
    }
    if (in_use) {
        // What frames show a voxel apart would be blurred.
        const double most_spread_m = settings_.map.voxel_size_m;
        std::vector<BlockMotion> motions =
            MotionOfBlocks(*in_use, keyframes_, graph, settings_.camera);
        for (const BlockCoord& c : doubtful_)
            motions[static_cast<std::size_t>(in_use->Find(c))].spread_m = BlockMotion::kDoubtful_m;
        MapWarp warp(*in_use, motions, settings_.fusion.volume.box(), most_spread_m, doubtful);
        rebuild_ = std::make_unique<MapRebuild>(settings_, std::move(graph), std::move(warp));
        return true;
    }
    std::unique_ptr<MapPager> pager;
    if (make_pager_) {
        Result<std::unique_ptr<MapPager>> made = make_pager_();
        if (!made.ok()) {
            StopRebuilding(made.status());
            return false;
        }
        pager = std::move(made.value());
    }
    std::unique_ptr<LabelMapper> labels;
    if (labels_)
        labels =
            std::make_unique<LabelMapper>(labels_->config, labels_->classes, settings_.camera,
                                          static_cast<float>(settings_.preparation.max_depth_m));
    rebuild_ = std::make_unique<MapRebuild>(settings_, std::move(graph), std::move(labels),
                                            std::move(pager));
    rebuild_->LeaveOut(left_out_);
    return true;
}

std::optional<LoopCloser::Correction> LoopCloser::Step(int frames) {
    if (!seeking_) return std::nullopt;
    moved_ = false;
    // Surfaces closer than that are one surface to tracking; what is left waits for the end.
    if (!BeginRebuild(settings_.map.truncation_m)) return std::nullopt;
    return StepRebuild(frames);
}

std::optional<LoopCloser::Correction> LoopCloser::StepRebuild(int frames) {
    // The map in use holds the latest frames, too.
    if (rebuild_->Left(store_) <= frames) StoreLatest();
    const Result<bool> done = rebuild_->Step(store_, frames);
    if (!done.ok()) StopRebuilding(done.status());
    if (!done.ok() || !done.value()) return std::nullopt;
    Correction correction;
    correction.map = rebuild_->TakeMap();
    correction.labels = rebuild_->TakeLabels();
    correction.pager = rebuild_->TakePager();
    doubtful_ = rebuild_->TakeDoubtful();
    correction.moved = rebuild_->has_copy();
    const int here = relocalised_at_.value_or(keyframes_.last().id);
    correction.T_new_old = Normalised(rebuild_->T_world_keyframe()[static_cast<std::size_t>(here)] *
                                      keyframes_[here].T_map_camera.inverse());
    for (int i = 0; i < keyframes_.size(); ++i)
        keyframes_[i].T_map_camera = rebuild_->T_world_keyframe()[static_cast<std::size_t>(i)];
    keyframes_.Move(correction.T_new_old);
    jumps_.Move(correction.T_new_old);
    rebuild_.reset();
    moved_ = swapped_ = true;
    return correction;
}

void LoopCloser::StopRebuilding(const Status& why) {
    rebuild_.reset();
    broken_ = true;
    trouble_ = "map correction stopped, the trajectory is still corrected: " + why.message();
}

std::optional<LoopCloser::Correction> LoopCloser::Finish(std::string& note,
                                                         const BlockMap* in_use) {
    std::optional<Correction> last;
    StoreLatest();
    if (seeking_ && corrected_) static_cast<void>(OptimiseAgain());  // else as it was
    if (config_.refine_calibration && !keyframes_.empty()) {
        const FieldSettings given = settings_;
        const Status status = Calibrate();
        note = status.ok() ? CalibrationText(given.camera, given.preparation.disparity_offset_per_m,
                                             *calibration_)
                           : status.message();
        if (calibration_ && calibration_->shown) {
            rebuild_.reset();
            in_use = nullptr;
            if (BeginRebuild(-1)) last = StepRebuild(std::numeric_limits<int>::max());
        }
    }
    if (const std::string left_out = KeepLargestPart(); !left_out.empty()) {
        note += (note.empty() ? "" : "; ") + left_out;
        rebuild_.reset();
        in_use = nullptr;
        if (BeginRebuild(-1)) last = StepRebuild(std::numeric_limits<int>::max());
    }
    if (!corrected_) return last;
    if (in_use && (PartsMove() || !MayMove(*in_use))) in_use = nullptr;
    const double tolerance_m = settings_.map.voxel_size_m / 2;
    // Discards a rebuild with outdated poses, one that takes longer than to move the map, and one
    // that lacks what has changed since.
    if (rebuild_ && (in_use || rebuild_->has_copy() ||
                     MaxDisplacement_m(rebuild_->T_world_keyframe()) >= tolerance_m))
        rebuild_.reset();
    while (BeginRebuild(doubtful_.empty() ? tolerance_m : -1, std::exchange(in_use, nullptr)))
        if (auto next = StepRebuild(std::numeric_limits<int>::max())) last = std::move(next);
    return last;
}

Result<LoopCloser::Correction> LoopCloser::MakeAgain() {
    constexpr int kMostRounds = 100;
    corrected_ = true;
    for (int round = 0; round < kMostRounds; ++round) {
        const bool last = FindOverlaps() == 0;
        if (Status solved = Optimise(); !solved.ok()) return solved;
        if (last) break;
    }
    static_cast<void>(KeepLargestPart());
    std::optional<Correction> made;
    if (BeginRebuild(-1)) made = StepRebuild(std::numeric_limits<int>::max());
    if (!made) return Status::Error(TakeError());
    return std::move(*made);
}

}  // namespace tessera
