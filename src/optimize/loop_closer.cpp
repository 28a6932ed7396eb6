#include "optimize/loop_closer.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "core/se3.h"

namespace tessera {
namespace {

std::size_t Bytes(double megabytes) { return static_cast<std::size_t>(megabytes * 1e6); }

}  // namespace

LoopCloser::LoopCloser(const LoopConfig& config, const FieldSettings& settings,
                       double depth_units_per_m, std::optional<Labels> labels, MakePager make_pager)
    : config_(config),
      settings_(settings),
      labels_(std::move(labels)),
      make_pager_(std::move(make_pager)),
      keyframes_(settings.camera, config.max_overlap, config.max_features),
      store_(Bytes(config.memory_limit_mb), depth_units_per_m),
      verifier_(settings, config) {}

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
    loops_ = memory.loops;
    corrected_ = memory.corrected;
    moved_ = true;
}

std::string LoopCloser::Add(const Frame& frame, const PreparedFrame& prepared,
                            const TrackResult& track, const Integrator::View& view, bool fused) {
    std::string news;
    const Eigen::Isometry3d& T_map_camera = track.T_world_camera;
    keyframes_.Follow(T_map_camera);
    // If the map holds some places twice, or was just replaced, tracking may jump from one surface
    // to the other. In that case a new keyframe starts here, linked at the pose where the camera
    // was expected.
    const std::optional<Eigen::Isometry3d> expected = jumps_.Follow(T_map_camera);
    const bool jumped = expected && (rebuild_ || swapped_) && !relocalised_at_;
    const bool keyframe =
        fused && (relocalised_at_ || jumped || keyframes_.Wanted(prepared, T_map_camera));
    if (keyframe) AddKeyframe(frame, prepared, track, jumped ? *expected : T_map_camera);
    if (keyframes_.empty()) return news;
    const Keyframe& last = keyframes_.last();
    AddPassage(frame.stamp_s, T_map_camera);
    if (!fused) return news;
    const Status stored =
        store_.Add(prepared.moving ? WithoutMoving(*prepared.moving, frame) : frame, last.id,
                   keyframe, passages_.back().T_keyframe_camera, view);
    if (keyframe && stored.ok()) {
        news = SeekLoop(last, prepared, view.motion);
        index_.Add(last.id, last.features.descriptors);
    }
    if (keyframe && rebuild_) {
        // Uses the relative pose of the graph: a loop may just have corrected the tracked one.
        const Keyframe& before = keyframes_[last.id - 1];
        rebuild_->AddKeyframe(Normalised(rebuild_->T_world_keyframe().back() *
                                         before.T_world_camera.inverse() * last.T_world_camera));
    }
    return stored.ok() ? news : stored.message();
}

void LoopCloser::Pass(double stamp_s, const Eigen::Isometry3d& T_map_camera) {
    keyframes_.Follow(T_map_camera);
    jumps_.Follow(T_map_camera);
    if (!keyframes_.empty()) AddPassage(stamp_s, T_map_camera);
}

void LoopCloser::AddPassage(double stamp_s, const Eigen::Isometry3d& T_map_camera) {
    const Keyframe& last = keyframes_.last();
    passages_.push_back({stamp_s, last.id, Normalised(last.T_map_camera.inverse() * T_map_camera)});
}

void LoopCloser::AddKeyframe(const Frame& frame, const PreparedFrame& prepared,
                             const TrackResult& track, const Eigen::Isometry3d& T_map_expected) {
    const bool first = keyframes_.empty();
    Keyframe& fresh = keyframes_.Add(frame.index, frame.stamp_s, prepared, track);
    if (!first) {
        const int from = relocalised_at_.value_or(fresh.id - 1);
        fresh.T_world_camera = Normalised(keyframes_[from].T_world_camera *
                                          keyframes_[from].T_map_camera.inverse() * T_map_expected);
        Link(from, fresh.id, T_map_expected);
    }
    relocalised_at_.reset();
    swapped_ = false;
}

void LoopCloser::Link(int from, int to, const Eigen::Isometry3d& T_map_to) {
    const Keyframe &a = keyframes_[from], &b = keyframes_[to], &before = keyframes_[to - 1];
    // Drift of tracking against the map: a constant per keyframe plus a share of the distance.
    constexpr double kTwice = 10.0;  // factor where tracking may have jumped
    const double trust =
        (b.inlier_fraction < config_.min_fit ? 2.0 : 1.0) * (rebuild_ || swapped_ ? kTwice : 1.0);
    edges_.push_back(
        {from, to, Normalised(a.T_map_camera.inverse() * T_map_to),
         trust * (0.002 + 0.01 * std::min(1.0, b.path_length_m - before.path_length_m)),
         trust * (0.002 + 0.01 * std::min(1.0, b.turned_rad - before.turned_rad)), false});
}

std::string LoopCloser::SeekLoop(const Keyframe& fresh, const PreparedFrame& prepared,
                                 const FrameMotion& motion) {
    const auto candidates = index_.Query(fresh.features.descriptors, fresh.id - config_.min_gap,
                                         config_.candidates, config_.min_votes);
    for (const PlaceIndex::Candidate& candidate : candidates) {
        const Keyframe& old = keyframes_[candidate.keyframe];
        const FieldVerdict verdict =
            verifier_.VerifyLoop(keyframes_, old, fresh, prepared, motion, store_);
        if (verdict.accepted) return CloseLoop(old, fresh, verdict);
    }
    return {};
}

// Keeps the tracked pose if tracking has already closed the loop: the full map is more accurate
// than two frames.
std::string LoopCloser::CloseLoop(const Keyframe& old, const Keyframe& fresh,
                                  const FieldVerdict& verdict) {
    constexpr double kSigma_m = 0.01, kSigma_rad = 0.005;
    const Eigen::Isometry3d T_old_new =
        verdict.closed_before ? Normalised(old.T_map_camera.inverse() * fresh.T_map_camera)
                              : verdict.T_old_new;
    edges_.push_back({old.id, fresh.id, T_old_new, kSigma_m, kSigma_rad, true});
    ++loops_;
    const Drift drift = DriftOf(old, fresh, T_old_new, config_.max_drift);
    if (drift.off_m < config_.min_correction_m && drift.off_rad < config_.min_correction_m)
        return {};
    corrected_ = true;
    if (Status solved = Optimise(); !solved.ok()) return solved.message();
    return fmt::format("loop closed with frame {}: {:.1f} cm and {:.1f} degrees off",
                       old.frame_index, 100 * drift.off_m, drift.off_rad * 57.29578);
}

// On error the keyframes do not move.
Status LoopCloser::Optimise() {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < keyframes_.size(); ++i) poses.push_back(keyframes_[i].T_world_camera);
    if (const auto report = OptimisePoses(edges_, poses); !report.ok()) return report.status();
    for (int i = 0; i < keyframes_.size(); ++i)
        keyframes_[i].T_world_camera = poses[static_cast<std::size_t>(i)];
    moved_ = true;
    return Status::Ok();
}

// Returns the place that explains the view best, if it does so much better than all others.
std::optional<Eigen::Isometry3d> LoopCloser::Relocalise(const PreparedFrame& frame,
                                                        std::string& note) {
    constexpr double kApart_m = 0.3, kApart_rad = 0.3, kAsWell = 0.6;
    // Factor compared with a loop: no prior pose narrows down the search.
    constexpr int kManyCandidates = 4;
    struct Place {
        int keyframe = 0;
        Eigen::Isometry3d T_map_camera;
        double explained = 0;
    };
    const Features features = ExtractFeatures(frame, settings_.camera, config_.max_features);
    std::vector<Place> places;
    relocalised_at_.reset();
    for (const auto& candidate :
         index_.Query(features.descriptors, keyframes_.size(), kManyCandidates * config_.candidates,
                      config_.min_votes)) {
        const Keyframe& old = keyframes_[candidate.keyframe];
        const FeatureMatch match = MatchFeatures(old.features, features, config_);
        if (!match.accepted) continue;
        const Eigen::Isometry3d T_guess = old.T_map_camera * match.T_old_new;
        const auto same = [&](const Place& place) {
            return (place.T_map_camera.translation() - T_guess.translation()).norm() <= kApart_m &&
                   RotationAngle(place.T_map_camera, T_guess) <= kApart_rad;
        };
        if (std::ranges::any_of(places, same)) continue;
        const FieldVerdict verdict =
            verifier_.VerifyPlace(keyframes_, old, frame, match.T_old_new, store_);
        if (verdict.accepted)
            places.push_back(
                {old.id, Normalised(old.T_map_camera * verdict.T_old_new), verdict.explained});
    }
    if (places.empty()) return std::nullopt;
    std::ranges::stable_sort(places, std::greater{}, &Place::explained);
    const Place& best = places.front();
    if (places.size() > 1 && places[1].explained >= kAsWell * best.explained) {
        note = fmt::format("ambiguous place: frame {} or frame {}",
                           keyframes_[best.keyframe].frame_index,
                           keyframes_[places[1].keyframe].frame_index);
        return std::nullopt;
    }
    relocalised_at_ = best.keyframe;
    note = fmt::format("relocalised at frame {}", keyframes_[best.keyframe].frame_index);
    keyframes_.Jump();
    jumps_.Reset();
    return best.T_map_camera;
}

std::vector<StampedPose> LoopCloser::Path() const {
    std::vector<StampedPose> path;
    for (const PathPose& p : passages_)
        path.push_back(
            {p.stamp_s, Normalised(keyframes_[p.keyframe].T_world_camera * p.T_keyframe_camera)});
    return path;
}

}  // namespace tessera
