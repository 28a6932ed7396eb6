#include "optimize/loop_closer.h"

#include <algorithm>
#include <utility>

#include "core/se3.h"
#include "optimize/texture_correlation.h"

namespace tessera {
namespace {

std::size_t Bytes(double megabytes) { return static_cast<std::size_t>(megabytes * 1e6); }

// True if direct alignment has already found the place: the field check, which costs a hundred
// times as much, would say the same.
bool Aligned(const Keyframe& fresh, const Keyframe& old) {
    constexpr int kBeside = 2;
    return std::ranges::any_of(fresh.overlaps, [&](const Overlap& overlap) {
        return std::abs(overlap.with - old.id) <= kBeside;
    });
}

}  // namespace

LoopCloser::LoopCloser(const LoopConfig& config, const FieldSettings& settings,
                       double depth_units_per_m, std::optional<Labels> labels, MakePager make_pager)
    : config_(config),
      settings_(settings),
      labels_(std::move(labels)),
      make_pager_(std::move(make_pager)),
      keyframes_(settings.camera, config.max_overlap, config.max_features),
      average_(settings.camera),
      store_(Bytes(config.memory_limit_mb), depth_units_per_m),
      verifier_(settings, config),
      overlaps_(settings.camera) {}

void LoopCloser::Resume(Memory memory) {
    keyframes_.Resume(std::move(memory.keyframes));
    for (int i = 0; i < keyframes_.size(); ++i) index_.Add(i, keyframes_[i].features.descriptors);
    edges_ = std::move(memory.edges);
    passages_ = std::move(memory.passages);
    // Drops detections of classes that this run does not have.
    for (StoredFrame& frame : memory.frames)
        if (frame.detections)
            std::erase_if(*frame.detections, [&](const Detection& d) {
                return !labels_ || d.class_id < 1 || d.class_id > labels_->classes.count();
            });
    store_.Resume(std::move(memory.frames), memory.next_ordinal);
    MakeMissingViews();
    loops_ = memory.loops;
    corrected_ = memory.corrected;
    moved_ = true;
}

// Old scan files have no reduced views.
void LoopCloser::MakeMissingViews() {
    Frame frame;
    PreparedFrame prepared;
    for (const StoredFrame& stored : store_.frames()) {
        if (!stored.is_keyframe || !keyframes_[stored.keyframe].reduced.empty()) continue;
        if (store_.LoadPrepared(stored, settings_.camera, settings_.preparation, frame, prepared)
                .ok())
            keyframes_[stored.keyframe].reduced =
                MakeReducedView(prepared, settings_.camera, stored.view.motion);
    }
}

std::string LoopCloser::Add(const Frame& frame, const PreparedFrame& prepared,
                            const TrackResult& track, const Integrator::View& view, bool fused) {
    std::string news;
    const Eigen::Isometry3d& T_map_camera = track.T_world_camera;
    Follow(T_map_camera);
    // Where the map holds a place twice, tracking may jump from one surface to the other. A new
    // keyframe starts there, so that the frames on both sides can move apart. If the map is known
    // to be like this, the keyframe is linked at the pose where the camera was expected.
    const std::optional<Eigen::Isometry3d> expected = jumps_.Follow(T_map_camera);
    const bool jumped = expected && !relocalised_at_;
    const bool keyframe =
        fused && (relocalised_at_ || jumped || keyframes_.Wanted(prepared, T_map_camera));
    if (keyframe)
        AddKeyframe(frame, prepared, track, view.motion,
                    jumped && outdated() ? *expected : T_map_camera, jumped || outdated());
    if (keyframes_.empty()) return news;
    const Keyframe& last = keyframes_.last();
    AddPassage(frame.stamp_s, T_map_camera, fused);
    if (!fused) return news;
    const Status stored =
        Store(prepared.moving ? WithoutMoving(*prepared.moving, frame) : frame, keyframe, view);
    if (keyframe && stored.ok()) {
        if (config_.overlaps) overlaps_.Find(keyframes_, last.id, true);
        if (seeking_) news = SeekLoop(last, prepared, view.motion);
        if (seeking_ && news.empty()) news = SeekDrift(last);
        if (seeking_ && news.empty()) news = SeekOtherParts(last, prepared);
        index_.Add(last.id, last.features.descriptors);
    }
    if (keyframe && rebuild_) {
        // Uses the relative pose of the graph: a loop may just have corrected the tracked one.
        const Keyframe& before = keyframes_[last.id - 1];
        rebuild_->AddKeyframe(Normalised(rebuild_->T_world_keyframe().back() *
                                         before.T_world_camera.inverse() * last.T_world_camera));
    }
    if (std::string trouble = store_.TakeTrouble(); !trouble.empty()) trouble_ = std::move(trouble);
    return stored.ok() ? news : stored.message();
}

// Keeps a frame of the last keyframe for corrected maps. Not averaged: the keyframe's own, which
// calibration compares with others; and all if objects are labelled, because detections belong to
// one image.
Status LoopCloser::Store(const Frame& frame, bool keyframe, const Integrator::View& view) {
    const Eigen::Isometry3d& T_keyframe_camera = passages_.back().T_keyframe_camera;
    const int id = keyframes_.last().id;
    const bool alone = keyframe || labels_ || !config_.average_frames;
    if (!alone && average_.Add(frame, T_keyframe_camera, view)) return Status::Ok();
    if (Status stored = StoreAverage(); !stored.ok()) return stored;
    if (alone) return store_.Add(frame, id, keyframe, T_keyframe_camera, view);
    average_.Begin(frame, T_keyframe_camera, view);
    average_keyframe_ = id;
    return Status::Ok();
}

Status LoopCloser::StoreAverage() {
    if (average_.empty()) return Status::Ok();
    return store_.Add(average_.Take(), average_keyframe_, false, average_.T_keyframe_camera(),
                      average_.view());
}

// The same where nobody awaits a status: a map without these frames is still a map.
void LoopCloser::StoreLatest() {
    if (Status stored = StoreAverage(); !stored.ok()) trouble_ = stored.message();
}

void LoopCloser::AddKeyframe(const Frame& frame, const PreparedFrame& prepared,
                             const TrackResult& track, const FrameMotion& motion,
                             const Eigen::Isometry3d& T_map_expected, bool doubtful) {
    const std::optional<int> from = LinkedTo(track.T_world_camera);
    if (!from) LeaveShortPartOut();
    Keyframe& fresh = keyframes_.Add(frame.index, frame.stamp_s, prepared, track, motion);
    if (from) {
        fresh.T_world_camera =
            Normalised(keyframes_[*from].T_world_camera * keyframes_[*from].T_map_camera.inverse() *
                       T_map_expected);
        Link(*from, fresh.id, T_map_expected, doubtful);
    } else {
        fresh.T_world_camera = fresh.T_map_camera;
    }
    relocalised_at_.reset();
    swapped_ = false;
}

void LoopCloser::Link(int from, int to, const Eigen::Isometry3d& T_map_to, bool doubtful) {
    const Keyframe &a = keyframes_[from], &b = keyframes_[to], &before = keyframes_[to - 1];
    // Drift of tracking against the map: a constant per keyframe plus a share of the distance.
    constexpr double kDoubtful = 10.0;  // factor where tracking may have jumped
    const double trust =
        (b.inlier_fraction < config_.min_fit ? 2.0 : 1.0) * (doubtful ? kDoubtful : 1.0);
    const double sigma_m = 0.002 + 0.01 * std::min(1.0, b.path_length_m - before.path_length_m),
                 sigma_rad = 0.002 + 0.01 * std::min(1.0, b.turned_rad - before.turned_rad);
    edges_.push_back({from, to, Normalised(a.T_map_camera.inverse() * T_map_to),
                      RootInformation(trust * sigma_rad, trust * sigma_m), false});
}

std::string LoopCloser::SeekLoop(const Keyframe& fresh, const PreparedFrame& prepared,
                                 const FrameMotion& motion) {
    const auto candidates = index_.Query(fresh.features.descriptors, fresh.id - config_.min_gap,
                                         config_.candidates, config_.min_votes);
    const bool judged = AlignedFactor(keyframes_).has_value();  // by SeekDrift
    for (const PlaceIndex::Candidate& candidate : candidates) {
        const Keyframe& old = keyframes_[candidate.keyframe];
        if (judged && Aligned(fresh, old)) continue;
        const LoopVerifier::Match match = verifier_.MatchKeyframes(old, fresh);
        if (!match.T_old_new ||
            (match.ask_for_texture && !ShowTheSame(old, fresh, *match.T_old_new)))
            continue;
        if (judged) {
            overlaps_.Align(keyframes_, fresh.id, old.id, *match.T_old_new, true);
            continue;
        }
        const FieldVerdict verdict = verifier_.VerifyLoop(keyframes_, old, fresh, *match.T_old_new,
                                                          prepared, motion, store_);
        if (verdict.accepted) return CloseLoop(old, fresh, verdict);
    }
    return {};
}

bool LoopCloser::ShowTheSame(const Keyframe& old, const Keyframe& fresh,
                             const Eigen::Isometry3d& T_old_new) {
    if (fresh.reduced.empty()) return false;
    const DenseView& view = overlaps_.ViewOf(fresh);
    const ViewAlignment aligned = overlaps_.AlignView(old, view, T_old_new);
    return aligned.converged && SameTexture(overlaps_.ViewOf(old), view, aligned.T_a_b);
}

// Keeps the tracked pose if tracking has already closed the loop: the full map is more accurate
// than two frames.
std::string LoopCloser::CloseLoop(const Keyframe& old, const Keyframe& fresh,
                                  const FieldVerdict& verdict) {
    constexpr double kSigma_m = 0.01, kSigma_rad = 0.005;
    const Eigen::Isometry3d T_old_new =
        verdict.closed_before ? Normalised(old.T_map_camera.inverse() * fresh.T_map_camera)
                              : verdict.T_old_new;
    edges_.push_back({old.id, fresh.id, T_old_new, RootInformation(kSigma_rad, kSigma_m), true});
    ++loops_;
    const Drift drift = DriftOf(old, fresh, T_old_new, config_.max_drift);
    if (drift.off_m < config_.min_correction_m && drift.off_rad < config_.min_correction_m)
        return {};
    if (Status solved = Optimise(); !solved.ok()) return solved.message();
    corrected_ = true;
    if (Status solved = OptimiseAgain(); !solved.ok()) return solved.message();
    return ClosedText(old, drift);
}

std::vector<StampedPose> LoopCloser::Path() const {
    std::vector<StampedPose> path;
    for (const PathPose& p : passages_)
        if (!LeftOut(p.keyframe))
            path.push_back({p.stamp_s, Normalised(keyframes_[p.keyframe].T_world_camera *
                                                  p.T_keyframe_camera)});
    return path;
}

}  // namespace tessera
