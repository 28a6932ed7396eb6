#include "optimize/map_corrector.h"

#include "core/memory.h"
#include "core/se3.h"
#include "optimize/map_motion.h"
#include "optimize/part_motion.h"

namespace tessera {

bool MapCorrector::WantsMap() const {
    return !made_ && !broken_ && graph_.corrected() && !make_pager_ && !labels_ &&
           graph_.Displacement_m() >= OneSurface_m();
}

double MapCorrector::OneSurface_m() const {
    return settings_.map.band().At(static_cast<float>(ScanGraph::kReach_m));
}

// An object that was seen at two places has two instances, which become one only by voting again.
// Unlike fusion, moving does not look at the free memory.
bool MapCorrector::MayMove(const BlockMap& in_use) const {
    if (make_pager_ || !MemoryHasRoomFor(in_use.bytes())) return false;
    return !labels_ || (in_use.has_labels() && graph_.Displacement_m() < OneSurface_m());
}

void MapCorrector::Move(std::unique_ptr<BlockMap> copy) {
    if (made_) return;
    if (copy && !MayMove(*copy)) copy.reset();
    if (Begin(OneSurface_m(), copy.get(), MapWarp::Doubtful::kMoved)) made_->Keep(std::move(copy));
}

bool MapCorrector::Begin(double tolerance_m, const BlockMap* in_use, MapWarp::Doubtful doubtful) {
    if (made_) return true;
    if (broken_ || !graph_.corrected() || graph_.Displacement_m() < tolerance_m) return false;
    if (in_use) {
        BeginMoved(*in_use, doubtful);
        return true;
    }
    std::unique_ptr<MapPager> pager;
    if (make_pager_) {
        Result<std::unique_ptr<MapPager>> made = make_pager_();
        if (!made.ok()) {
            Stop(made.status());
            return false;
        }
        pager = std::move(made.value());
    }
    std::unique_ptr<LabelMapper> labels;
    if (labels_)
        labels =
            std::make_unique<LabelMapper>(labels_->config, labels_->classes, settings_.camera,
                                          static_cast<float>(settings_.preparation.max_depth_m));
    made_ = std::make_unique<MapRebuild>(settings_, graph_.Poses(), std::move(labels),
                                         std::move(pager));
    made_->LeaveOut(graph_.left_out());
    return true;
}

void MapCorrector::BeginParts(const BlockMap& in_use) {
    MovedParts moved = MoveParts(in_use, graph_, settings_.fusion.volume.box(), doubtful_);
    made_ = std::make_unique<MapRebuild>(settings_, std::move(moved.T_map_keyframe),
                                         std::move(moved.map), std::move(moved.doubtful));
}

void MapCorrector::BeginMoved(const BlockMap& in_use, MapWarp::Doubtful doubtful) {
    if (graph_.PartsMove()) return BeginParts(in_use);
    // What frames show a voxel apart would be blurred.
    const double most_spread_m = settings_.map.voxel_size_m;
    std::vector<Eigen::Isometry3d> poses = graph_.Poses();
    std::vector<BlockMotion> motions =
        MotionOfBlocks(in_use, graph_.keyframes(), poses, settings_.camera);
    for (const BlockCoord& c : doubtful_)
        motions[static_cast<std::size_t>(in_use.Find(c))].spread_m = BlockMotion::kDoubtful_m;
    MapWarp warp(in_use, motions, settings_.fusion.volume.box(), most_spread_m, doubtful);
    made_ = std::make_unique<MapRebuild>(settings_, std::move(poses), std::move(warp));
}

void MapCorrector::AddKeyframe() {
    if (!made_) return;
    const Keyframe &last = graph_.keyframes().last(), &before = graph_.keyframes()[last.id - 1];
    made_->AddKeyframe(Normalised(made_->T_world_keyframe().back() *
                                  before.T_world_camera.inverse() * last.T_world_camera));
}

std::unique_ptr<MapRebuild> MapCorrector::Step(int frames) {
    // The map in use holds the latest frames, too.
    if (made_->Left(store_) <= frames) store_.StoreLatest();
    const Result<bool> done = made_->Step(store_, frames);
    if (!done.ok()) Stop(done.status());
    if (!done.ok() || !done.value()) return nullptr;
    doubtful_ = made_->TakeDoubtful();
    return std::move(made_);
}

void MapCorrector::DiscardOutdated(double tolerance_m) {
    if (moves_copy() || (made_ && graph_.Displacement_m(made_->T_world_keyframe()) >= tolerance_m))
        made_.reset();
}

void MapCorrector::Stop(const Status& why) {
    made_.reset();
    broken_ = true;
    trouble_ = "map correction stopped, the trajectory is still corrected: " + why.message();
}

}  // namespace tessera
