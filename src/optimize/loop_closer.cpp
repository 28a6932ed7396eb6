#include "optimize/loop_closer.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/se3.h"

namespace tessera {
namespace {

std::size_t Bytes(double megabytes) { return static_cast<std::size_t>(megabytes * 1e6); }

}  // namespace

LoopCloser::LoopCloser(const LoopConfig& config, const FieldSettings& settings,
                       double depth_units_per_m, std::optional<Labels> labels, MakePager make_pager)
    : config_(config),
      settings_(settings),
      store_(Bytes(config.memory_limit_mb), depth_units_per_m),
      graph_(config, settings.camera),
      places_(config, settings, graph_, store_),
      joiner_(graph_),
      corrector_(settings_, graph_, store_, std::move(labels), std::move(make_pager)) {}

void LoopCloser::Resume(Memory memory) {
    graph_.Resume(std::move(memory.graph));
    // Drops detections of classes that this run does not have.
    const std::optional<Labels>& labels = corrector_.labels();
    for (StoredFrame& frame : memory.frames) {
        if (!frame.detections) continue;
        std::vector<Detection> detections = frame.detections->Unpack();
        const auto unknown = [&](const Detection& d) {
            return !labels || d.class_id < 1 || d.class_id > labels->classes.count();
        };
        if (std::erase_if(detections, unknown) > 0)
            frame.detections = StoredDetections(std::move(detections), frame.detections->ignored());
    }
    store_.Resume(std::move(memory.frames), memory.next_ordinal);
    AddPlaces();
    MakeMissingViews();
}

// A place is verified with its keyframe's own frame, which a damaged scan may lack.
void LoopCloser::AddPlaces() {
    const Keyframes& keyframes = graph_.keyframes();
    std::vector<bool> stored(static_cast<std::size_t>(keyframes.size()), false);
    for (const StoredFrame& frame : store_.frames())
        if (frame.is_keyframe) stored[static_cast<std::size_t>(frame.keyframe)] = true;
    for (const Keyframe& keyframe : keyframes.all())
        if (stored[static_cast<std::size_t>(keyframe.id)]) places_.Add(keyframe);
}

// Old scan files have no reduced views.
void LoopCloser::MakeMissingViews() {
    Keyframes& keyframes = graph_.keyframes();
    Frame frame;
    PreparedFrame prepared;
    for (const StoredFrame& stored : store_.frames()) {
        if (!stored.is_keyframe || !keyframes[stored.keyframe].reduced.empty()) continue;
        if (store_.LoadPrepared(stored, settings_.camera, settings_.preparation, frame, prepared)
                .ok())
            keyframes[stored.keyframe].reduced =
                MakeReducedView(prepared, settings_.camera, stored.view.motion);
    }
}

// Takes note of a tracked camera. Where a part begins, or the camera was found in another one, it
// has not moved from the last pose to this one. A frame that was tracked later than the camera was
// found, but not there, shows that it came back by itself. Returns where the camera was expected,
// if tracking may have jumped.
std::optional<Eigen::Isometry3d> LoopCloser::Follow(double stamp_s,
                                                    const Eigen::Isometry3d& T_map_camera,
                                                    bool fused) {
    if (!link_ && stamp_s > seen_at_s_) seen_at_.reset();
    Keyframes& keyframes = graph_.keyframes();
    if (!keyframes.empty() && !InOnePart(keyframes.T_map_last(), T_map_camera)) Interrupt();
    keyframes.Follow(T_map_camera);
    fused_since_copy_ |= fused;
    return jumps_.Follow(stamp_s, T_map_camera);
}

std::string LoopCloser::Add(const Frame& frame, const PreparedFrame& prepared,
                            const TrackResult& track, const Integrator::View& view, bool fused) {
    const Eigen::Isometry3d& T_map_camera = track.T_world_camera;
    Keyframes& keyframes = graph_.keyframes();
    const std::optional<Eigen::Isometry3d> expected = Follow(frame.stamp_s, T_map_camera, fused);
    // A corrected map may hold what this one does. It was left out of frames with a lower limit.
    settings_.preparation.max_depth_m =
        std::max(settings_.preparation.max_depth_m, prepared.limit_m);
    // Where the map holds a place twice, tracking may jump from one surface to the other. A new
    // keyframe starts there, so that the frames on both sides can move apart. If the map is known
    // to be like this, the keyframe is linked at the pose where the camera was expected.
    const bool jumped = expected && !link_;
    const bool keyframe = fused && (link_ || jumped || keyframes.Wanted(prepared, T_map_camera));
    if (keyframe)
        AddKeyframe(frame, prepared, track, view.motion,
                    jumped && outdated() ? *expected : T_map_camera, jumped || outdated());
    if (keyframes.empty()) return {};
    graph_.AddPassage(frame.stamp_s, T_map_camera, fused);
    if (!fused) return {};
    const Keyframe& last = keyframes.last();
    const Eigen::Isometry3d& T_keyframe_camera = graph_.passages().back().T_keyframe_camera;
    // Calibration compares the keyframes' own frames, and detections belong to one image.
    const bool averaged = config_.average_frames && !keyframe && !corrector_.labels();
    const Frame kept = WithoutLeftOut(frame, prepared, settings_.preparation);
    const Status stored =
        averaged ? store_.AddAveraged(kept, settings_.camera, last.id, T_keyframe_camera, view)
                 : store_.Add(kept, last.id, keyframe, T_keyframe_camera, view);
    std::string news;
    if (keyframe && stored.ok()) {
        if (config_.overlaps) graph_.overlaps().Find(keyframes, last.id, true);
        if (seeking_) news = SeekLoop(last, prepared, view.motion);
        if (seeking_ && news.empty()) news = SeekDrift();
        if (seeking_ && news.empty()) news = SeekOtherParts(last, prepared);
        places_.Add(last);
    }
    if (keyframe) corrector_.AddKeyframe();  // a loop may just have moved it in the graph
    return stored.ok() ? news : stored.message();
}

void LoopCloser::AddKeyframe(const Frame& frame, const PreparedFrame& prepared,
                             const TrackResult& track, const FrameMotion& motion,
                             const Eigen::Isometry3d& T_map_expected, bool doubtful) {
    const std::optional<int> from = LinkedTo(track.T_world_camera);
    if (!from) graph_.LeaveShortPartOut();
    Keyframes& keyframes = graph_.keyframes();
    Keyframe& fresh = keyframes.Add(frame.index, frame.stamp_s, prepared, track, motion);
    if (from) {
        fresh.T_world_camera = Normalised(keyframes[*from].T_world_camera *
                                          keyframes[*from].T_map_camera.inverse() * T_map_expected);
        graph_.Link(*from, fresh.id, T_map_expected, doubtful);
    } else {
        fresh.T_world_camera = fresh.T_map_camera;
    }
    link_.reset();
    seen_at_.reset();
    swapped_ = false;
}

// The keyframe that a new one is linked to. None if it begins a part.
std::optional<int> LoopCloser::LinkedTo(const Eigen::Isometry3d& T_map_camera) const {
    if (link_ && InOnePart(graph_.keyframes()[*link_].T_map_camera, T_map_camera)) return link_;
    return graph_.NewestInPartOf(T_map_camera);
}

void LoopCloser::Pass(double stamp_s, const Eigen::Isometry3d& T_map_camera, bool fused) {
    Follow(stamp_s, T_map_camera, fused);
    graph_.AddPassage(stamp_s, T_map_camera, fused);
}

std::optional<FoundCamera> LoopCloser::Relocalise(
    double stamp_s, const PreparedFrame& frame, std::string& note,
    const std::optional<Eigen::Isometry3d>& T_map_expected) {
    seen_at_.reset();
    const Keyframes& keyframes = graph_.keyframes();
    const Features features = ExtractFeatures(frame, settings_.camera, config_.max_features);
    const DenseView dense =
        MakeDenseView(MakeReducedView(frame, settings_.camera, {}), settings_.camera);
    const std::vector<PlaceFinder::Place> places = places_.BestOfParts(
        {features, dense, frame},
        [&](int id) {
            return !T_map_expected || InOnePart(keyframes[id].T_map_camera, *T_map_expected);
        },
        note);
    if (places.empty()) return std::nullopt;
    const PlaceFinder::Place& best =
        *std::ranges::max_element(places, {}, [this](const PlaceFinder::Place& place) {
            return graph_.KeyframesInPartOf(place.T_map_camera);
        });
    seen_at_ = best.keyframe;
    seen_at_s_ = stamp_s;
    note = fmt::format("relocalised at frame {}", keyframes[best.keyframe].frame_index);
    if (std::string joined = joiner_.JoinAt(places); !joined.empty()) note += "; " + joined;
    return FoundCamera{Normalised(best.T_map_camera), best.keyframe};
}

void LoopCloser::LinkNextTo(int keyframe) {
    link_ = keyframe;
    Interrupt();
}

// The motion between the last frame and the next is not known.
void LoopCloser::Interrupt() {
    graph_.keyframes().Jump();
    jumps_.Reset();
    DiscardCopy();
}

// The camera is elsewhere. What was fused since the map was copied would follow it there, so the
// map is asked for once more.
void LoopCloser::DiscardCopy() {
    if (!corrector_.moves_copy() || !fused_since_copy_) return;
    corrector_.Discard();
    graph_.MarkMoved();
}

std::string LoopCloser::TakeError() {
    std::string trouble = corrector_.TakeTrouble();
    return trouble.empty() ? store_.TakeTrouble() : trouble;
}

}  // namespace tessera
