// A scan in parts, of LoopCloser: which keyframes belong together, how two parts are joined, and
// what remains of several at the end.
#include <fmt/format.h>

#include <algorithm>

#include "core/se3.h"
#include "optimize/loop_closer.h"

namespace tessera {

// Takes note of a tracked camera. Where a part begins, or the camera was found in another one, it
// has not moved from the last pose to this one.
void LoopCloser::Follow(const Eigen::Isometry3d& T_map_camera) {
    if (!keyframes_.empty() && !InOnePart(keyframes_.T_map_last(), T_map_camera)) {
        keyframes_.Jump();
        jumps_.Reset();
    }
    keyframes_.Follow(T_map_camera);
}

std::optional<int> LoopCloser::LatestInPartOf(const Eigen::Isometry3d& T_map_camera) const {
    for (int id = keyframes_.size() - 1; id >= 0; --id)
        if (InOnePart(keyframes_[id].T_map_camera, T_map_camera)) return id;
    return std::nullopt;
}

// The keyframe that a new one is linked to. None if it begins a part.
std::optional<int> LoopCloser::LinkedTo(const Eigen::Isometry3d& T_map_camera) const {
    if (relocalised_at_ && InOnePart(keyframes_[*relocalised_at_].T_map_camera, T_map_camera))
        return relocalised_at_;
    return LatestInPartOf(T_map_camera);
}

void LoopCloser::Pass(double stamp_s, const Eigen::Isometry3d& T_map_camera, bool fused) {
    Follow(T_map_camera);
    jumps_.Follow(T_map_camera);
    AddPassage(stamp_s, T_map_camera, fused);
}

void LoopCloser::AddPassage(double stamp_s, const Eigen::Isometry3d& T_map_camera, bool fused) {
    const std::optional<int> id = LatestInPartOf(T_map_camera);
    if (!id) return;
    const Eigen::Isometry3d T_keyframe_map = keyframes_[*id].T_map_camera.inverse();
    passages_.push_back({stamp_s, *id, Normalised(T_keyframe_map * T_map_camera), fused});
}

// Looks for a keyframe among those of other parts.
std::string LoopCloser::SeekOtherParts(const Keyframe& fresh, const PreparedFrame& prepared) {
    const std::vector<int> parts = PartsOf(edges_, keyframes_.size());
    if (std::ranges::count(parts, 0) == std::ssize(parts)) return {};
    const auto elsewhere = [&parts, here = parts.back()](int id) {
        return parts[static_cast<std::size_t>(id)] != here;
    };
    std::string ignored;
    std::vector<Place> places =
        BestOfParts(fresh.features, overlaps_.ViewOf(fresh), prepared, elsewhere, ignored);
    places.push_back({fresh.id, Eigen::Isometry3d::Identity(), fresh.T_map_camera, 0});
    return JoinAt(places);
}

std::ptrdiff_t LoopCloser::KeyframesAround(const Eigen::Isometry3d& T_map_camera) const {
    return std::ranges::count_if(keyframes_.all(), [&](const Keyframe& keyframe) {
        return InOnePart(keyframe.T_map_camera, T_map_camera);
    });
}

// One view was found at these places, each in another part. Where enough such places agree, two
// parts are joined. Returns a message for the user, usually empty.
std::string LoopCloser::JoinAt(const std::vector<Place>& places) {
    std::string news;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const std::vector<int> parts = PartsOf(edges_, keyframes_.size());
            const auto part_of = [&parts](const Place& place) {
                return parts[static_cast<std::size_t>(place.keyframe)];
            };
            const Place *a = &places[i], *b = &places[k];
            if (part_of(*a) == part_of(*b)) continue;
            if (part_of(*a) > part_of(*b)) std::swap(a, b);  // the part that began later moves
            common_.push_back(
                {a->keyframe, b->keyframe, Normalised(a->T_old_new * b->T_old_new.inverse()), {}});
            if (std::string joined = JoinParts(part_of(*a), part_of(*b)); !joined.empty())
                news = std::move(joined);
        }
    return news;
}

// Joins these parts if enough of their common places agree. Returns a message for the user.
std::string LoopCloser::JoinParts(int a, int b) {
    const std::vector<int> parts = PartsOf(edges_, keyframes_.size());
    const auto part_of = [&parts](int id) { return parts[static_cast<std::size_t>(id)]; };
    std::vector<CommonPlace> places;
    for (CommonPlace place : common_) {
        if (part_of(place.in_a) != a || part_of(place.in_b) != b) continue;
        place.T_world_a_in_b = keyframes_[place.in_a].T_world_camera * place.T_in_a_in_b;
        places.push_back(place);
    }
    const std::optional<JointPose> joint = AgreeOnPose(places, keyframes_.all());
    if (!joint) return {};
    for (int id = 0; id < keyframes_.size(); ++id)
        if (part_of(id) == b)
            keyframes_[id].T_world_camera =
                Normalised(joint->T_a_b * keyframes_[id].T_world_camera);
    for (const CommonPlace& place : joint->places) edges_.push_back(EdgeAt(place));
    std::erase_if(common_, [&](const CommonPlace& place) {
        return part_of(place.in_a) == a && part_of(place.in_b) == b;
    });
    ++loops_;
    corrected_ = moved_ = true;
    if (Status solved = OptimiseAgain(); !solved.ok()) return solved.message();
    return fmt::format(
        "the part of the scan that began at frame {} is joined with that of frame {}",
        keyframes_[b].frame_index, keyframes_[a].frame_index);
}

// The part of the last keyframe has ended. What it has seen is so little that the camera, found
// there, would soon be lost again.
void LoopCloser::LeaveShortPartOut() {
    constexpr std::ptrdiff_t kFew = 10;  // as in LossWatch
    if (keyframes_.empty()) return;
    const std::vector<int> parts = PartsOf(edges_, keyframes_.size());
    const auto here = [&parts](int id) {
        return parts[static_cast<std::size_t>(id)] == parts.back();
    };
    if (std::ranges::count_if(passages_, here, &PathPose::keyframe) > kFew) return;
    left_out_.resize(parts.size());
    for (int id = 0; id < keyframes_.size(); ++id)
        if (here(id)) left_out_[static_cast<std::size_t>(id)] = true;
}

// Two parts were joined, but are not yet in the map.
bool LoopCloser::PartsMove() const { return MaxDisplacement_m(MapPoses()) > kPartsApart_m / 2; }

// At the end: parts that were not joined are left out, but for the one with most frames in the map.
// Its first camera is then that of the world. Returns a message for the user, empty if there is
// only one.
std::string LoopCloser::KeepLargestPart() {
    const std::vector<int> parts = PartsOf(edges_, keyframes_.size());
    std::vector<int> frames(parts.size(), 0), fused = frames;  // by the part's first keyframe
    for (const PathPose& p : passages_) {
        const auto part = static_cast<std::size_t>(parts[static_cast<std::size_t>(p.keyframe)]);
        ++frames[part];
        fused[part] += p.fused;
    }
    const int kept = static_cast<int>(std::ranges::max_element(fused) - fused.begin());
    int count = 0, lost = 0;
    for (int id = 0; id < keyframes_.size(); ++id) {
        if (parts[static_cast<std::size_t>(id)] != id || id == kept) continue;
        ++count;
        lost += frames[static_cast<std::size_t>(id)];
    }
    if (count == 0) return {};
    left_out_.clear();
    for (const int part : parts) left_out_.push_back(part != kept);
    if (kept != 0) {
        const Eigen::Isometry3d T_first_world = keyframes_[kept].T_world_camera.inverse();
        for (int id = 0; id < keyframes_.size(); ++id)
            keyframes_[id].T_world_camera =
                Normalised(T_first_world * keyframes_[id].T_world_camera);
    }
    corrected_ = true;
    return fmt::format(
        "{} frames are left out: they saw {}, and nothing shows where that lies in the scan", lost,
        count == 1 ? "another part of the scene" : fmt::format("{} other parts", count));
}

}  // namespace tessera
