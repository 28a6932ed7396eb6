#include "optimize/loop_closer.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "core/se3.h"

namespace tessera {
namespace {

std::size_t Bytes(double megabytes) { return static_cast<std::size_t>(megabytes * 1e6); }

}  // namespace

LoopCloser::LoopCloser(const LoopConfig& config, const FieldSettings& settings, double depth_units_per_m,
                       std::optional<Labels> labels, MakePager make_pager)
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
    // Detections of classes that this run does not have.
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

std::string LoopCloser::Add(const Frame& frame, const PreparedFrame& prepared, const TrackResult& track,
                            const Integrator::View& view, bool fused) {
    std::string news;
    const Eigen::Isometry3d& T_map_camera = track.T_world_camera;
    keyframes_.Follow(T_map_camera);
    const bool keyframe = fused && (relocalised_at_ || keyframes_.Wanted(prepared, T_map_camera));
    if (keyframe) AddKeyframe(frame, prepared, track);
    if (keyframes_.empty()) return news;
    const Keyframe& last = keyframes_.last();
    AddPassage(frame.stamp_s, T_map_camera);
    if (!fused) return news;
    if (Status stored = store_.Add(frame, last.id, keyframe, passages_.back().T_keyframe_camera, view); !stored.ok())
        return stored.message();
    if (keyframe) {
        news = SeekLoop(last, prepared, view.motion);
        index_.Add(last.id, last.features.descriptors);
    }
    return news;
}

void LoopCloser::Pass(double stamp_s, const Eigen::Isometry3d& T_map_camera) {
    keyframes_.Follow(T_map_camera);
    if (!keyframes_.empty()) AddPassage(stamp_s, T_map_camera);
}

void LoopCloser::AddPassage(double stamp_s, const Eigen::Isometry3d& T_map_camera) {
    const Keyframe& last = keyframes_.last();
    passages_.push_back({stamp_s, last.id, Normalised(last.T_map_camera.inverse() * T_map_camera)});
}

void LoopCloser::AddKeyframe(const Frame& frame, const PreparedFrame& prepared, const TrackResult& track) {
    const bool first = keyframes_.empty();
    Keyframe& fresh = keyframes_.Add(frame.index, frame.stamp_s, prepared, track);
    if (!first) {
        const int from = relocalised_at_.value_or(fresh.id - 1);
        fresh.T_world_camera = Normalised(keyframes_[from].T_world_camera * keyframes_[from].T_map_camera.inverse() *
                                          fresh.T_map_camera);
        Link(from, fresh.id);
    }
    relocalised_at_.reset();
    if (rebuild_) {
        const int from = std::max(fresh.id - 1, 0);
        rebuild_->AddKeyframe(Normalised(rebuild_->T_world_keyframe()[static_cast<std::size_t>(from)] *
                                         keyframes_[from].T_map_camera.inverse() * fresh.T_map_camera));
    }
}

void LoopCloser::Link(int from, int to) {
    const Keyframe &a = keyframes_[from], &b = keyframes_[to], &before = keyframes_[to - 1];
    // What tracking against the map loses on the way: a little for each keyframe, and a share of the way.
    // While a map is in use that is known to hold a place twice, tracking may jump from the one to the other.
    constexpr double kTwice = 10.0;
    const double trust = (b.inlier_fraction < config_.min_fit ? 2.0 : 1.0) * (rebuild_ ? kTwice : 1.0);
    edges_.push_back({from, to, Normalised(a.T_map_camera.inverse() * b.T_map_camera),
                      trust * (0.002 + 0.01 * std::min(1.0, b.way_m - before.way_m)),
                      trust * (0.002 + 0.01 * std::min(1.0, b.turned_rad - before.turned_rad)), false});
}

std::string LoopCloser::SeekLoop(const Keyframe& fresh, const PreparedFrame& prepared, const FrameMotion& motion) {
    const auto candidates = index_.Query(fresh.features.descriptors, fresh.id - config_.min_gap, config_.candidates,
                                         config_.min_votes);
    for (const PlaceIndex::Candidate& candidate : candidates) {
        const Keyframe& old = keyframes_[candidate.keyframe];
        const FieldVerdict verdict = verifier_.VerifyLoop(keyframes_, old, fresh, prepared, motion, store_);
        if (verdict.accepted) return CloseLoop(old, fresh, verdict);
    }
    return {};
}

// A loop that tracking has closed by itself is kept as it is: the whole map knows better than two frames.
std::string LoopCloser::CloseLoop(const Keyframe& old, const Keyframe& fresh, const FieldVerdict& verdict) {
    constexpr double kSigma_m = 0.01, kSigma_rad = 0.005;
    const Eigen::Isometry3d T_old_new =
        verdict.closed_before ? Normalised(old.T_map_camera.inverse() * fresh.T_map_camera) : verdict.T_old_new;
    edges_.push_back({old.id, fresh.id, T_old_new, kSigma_m, kSigma_rad, true});
    ++loops_;
    const Drift drift = DriftOf(old, fresh, T_old_new, config_.max_drift);
    if (drift.off_m < config_.min_correction_m && drift.off_rad < config_.min_correction_m) return {};
    corrected_ = true;
    if (Status solved = Optimise(); !solved.ok()) return solved.message();
    return fmt::format("loop closed with frame {}: {:.1f} cm and {:.1f} degrees off", old.frame_index, 100 * drift.off_m,
                       drift.off_rad * 57.29578);
}

// Of any point half a view away, between a map made with these poses of the keyframes and the pose graph.
double LoopCloser::FarthestOff_m(const std::vector<Eigen::Isometry3d>& T_map_keyframe) const {
    constexpr double kReach_m = 2.0;
    double farthest = 0;
    for (int i = 0; i < keyframes_.size(); ++i) {
        const Eigen::Isometry3d &map = T_map_keyframe[static_cast<std::size_t>(i)], &graph = keyframes_[i].T_world_camera;
        farthest = std::max(farthest, (map.translation() - graph.translation()).norm() + kReach_m * RotationAngle(map, graph));
    }
    return farthest;
}

// On error the keyframes stay where they are.
Status LoopCloser::Optimise() {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < keyframes_.size(); ++i) poses.push_back(keyframes_[i].T_world_camera);
    if (const auto report = OptimisePoses(edges_, poses); !report.ok()) return report.status();
    for (int i = 0; i < keyframes_.size(); ++i) keyframes_[i].T_world_camera = poses[static_cast<std::size_t>(i)];
    moved_ = true;
    return Status::Ok();
}

// True if one is under way, or if the map is off by more than the tolerance.
bool LoopCloser::BeginRebuild(double tolerance_m) {
    if (rebuild_) return true;
    if (broken_ || !corrected_) return false;
    std::vector<Eigen::Isometry3d> map, graph;
    for (int i = 0; i < keyframes_.size(); ++i) {
        map.push_back(keyframes_[i].T_map_camera);
        graph.push_back(keyframes_[i].T_world_camera);
    }
    if (FarthestOff_m(map) < tolerance_m) return false;
    std::unique_ptr<MapPager> pager;
    if (make_pager_) {
        Result<std::unique_ptr<MapPager>> made = make_pager_();
        if (!made.ok()) {
            GiveUp(made.status());
            return false;
        }
        pager = std::move(made.value());
    }
    std::unique_ptr<LabelMapper> labels;
    if (labels_) labels = std::make_unique<LabelMapper>(labels_->config, labels_->classes, settings_.camera,
                                                        static_cast<float>(settings_.preparation.max_depth_m));
    rebuild_ = std::make_unique<MapRebuild>(settings_, std::move(graph), std::move(labels), std::move(pager));
    return true;
}

std::optional<LoopCloser::Correction> LoopCloser::Step(int frames) {
    moved_ = false;
    if (!BeginRebuild(settings_.map.voxel_size_m / 2)) return std::nullopt;
    return StepRebuild(frames);
}

std::optional<LoopCloser::Correction> LoopCloser::StepRebuild(int frames) {
    const Result<bool> done = rebuild_->Step(store_, frames);
    if (!done.ok()) GiveUp(done.status());
    if (!done.ok() || !done.value()) return std::nullopt;
    Correction correction;
    correction.map = rebuild_->TakeMap();
    correction.labels = rebuild_->TakeLabels();
    correction.pager = rebuild_->TakePager();
    correction.T_new_old =
        Normalised(rebuild_->T_world_keyframe().back() * keyframes_.last().T_map_camera.inverse());
    for (int i = 0; i < keyframes_.size(); ++i)
        keyframes_[i].T_map_camera = rebuild_->T_world_keyframe()[static_cast<std::size_t>(i)];
    keyframes_.Move(correction.T_new_old);
    rebuild_.reset();
    moved_ = true;
    return correction;
}

void LoopCloser::GiveUp(const Status& why) {
    rebuild_.reset();
    broken_ = true;
    trouble_ = "the map is no longer corrected, the path is: " + why.message();
}

std::optional<LoopCloser::Correction> LoopCloser::Finish(std::string& note) {
    std::optional<Correction> last;
    if (corrected_) static_cast<void>(Optimise());  // if it fails, what was corrected before holds
    if (config_.refine_calibration && !keyframes_.empty()) {
        const FieldSettings given = settings_;
        const Status status = Calibrate();
        note = status.ok() ? CalibrationText(given.camera, given.preparation.disparity_offset_per_m, *calibration_)
                           : status.message();
        if (calibration_ && calibration_->shown) {
            rebuild_.reset();
            if (BeginRebuild(-1)) last = StepRebuild(std::numeric_limits<int>::max());
        }
    }
    if (!corrected_) return last;
    const double tolerance_m = settings_.map.voxel_size_m / 10;
    if (rebuild_ && FarthestOff_m(rebuild_->T_world_keyframe()) >= tolerance_m) rebuild_.reset();  // of a path that is no more
    while (BeginRebuild(tolerance_m))
        if (auto next = StepRebuild(std::numeric_limits<int>::max())) last = std::move(next);
    return last;
}

// Of several places the one that explains the view, if it does so far better than any other.
std::optional<Eigen::Isometry3d> LoopCloser::Relocalise(const PreparedFrame& frame, std::string& note) {
    constexpr double kApart_m = 0.3, kApart_rad = 0.3, kAsWell = 0.6;
    constexpr int kManyCandidates = 4;  // times as many as for a loop: nothing else tells where the camera is
    struct Place {
        int keyframe = 0;
        Eigen::Isometry3d T_map_camera;
        double explained = 0;
    };
    const Features features = ExtractFeatures(frame, settings_.camera, config_.max_features);
    std::vector<Place> places;
    relocalised_at_.reset();
    for (const auto& candidate : index_.Query(features.descriptors, keyframes_.size(),
                                              kManyCandidates * config_.candidates, config_.min_votes)) {
        const Keyframe& old = keyframes_[candidate.keyframe];
        const FeatureMatch match = MatchFeatures(old.features, features, config_);
        if (!match.accepted) continue;
        const Eigen::Isometry3d T_guess = old.T_map_camera * match.T_old_new;
        const auto same = [&](const Place& place) {
            return (place.T_map_camera.translation() - T_guess.translation()).norm() <= kApart_m &&
                   RotationAngle(place.T_map_camera, T_guess) <= kApart_rad;
        };
        if (std::ranges::any_of(places, same)) continue;
        const FieldVerdict verdict = verifier_.VerifyPlace(keyframes_, old, frame, match.T_old_new, store_);
        if (verdict.accepted) places.push_back({old.id, Normalised(old.T_map_camera * verdict.T_old_new), verdict.explained});
    }
    if (places.empty()) return std::nullopt;
    std::ranges::stable_sort(places, std::greater{}, &Place::explained);
    const Place& best = places.front();
    if (places.size() > 1 && places[1].explained >= kAsWell * best.explained) {
        note = fmt::format("this could be at frame {} or at frame {}", keyframes_[best.keyframe].frame_index,
                           keyframes_[places[1].keyframe].frame_index);
        return std::nullopt;
    }
    relocalised_at_ = best.keyframe;
    note = fmt::format("found again, at frame {}", keyframes_[best.keyframe].frame_index);
    keyframes_.Jump();
    return best.T_map_camera;
}

std::vector<StampedPose> LoopCloser::Path() const {
    std::vector<StampedPose> path;
    for (const Passage& p : passages_)
        path.push_back({p.stamp_s, Normalised(keyframes_[p.keyframe].T_world_camera * p.T_keyframe_camera)});
    return path;
}

}  // namespace tessera
