// A scan in parts, of LoopCloser: which keyframes belong together, how two parts are joined, and
// what remains of several at the end.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/se3.h"
#include "mapping/map_delta.h"
#include "optimize/block_mover.h"
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
    const std::vector<int> parts = PartsOf(edges_, keyframes_.all());
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
            const std::vector<int> parts = PartsOf(edges_, keyframes_.all());
            const auto part_of = [&parts](const Place& place) {
                return parts[static_cast<std::size_t>(place.keyframe)];
            };
            const Place *a = &places[i], *b = &places[k];
            if (part_of(*a) == part_of(*b)) continue;
            if (part_of(*a) > part_of(*b)) std::swap(a, b);  // the part that began later moves
            common_.push_back(
                {a->keyframe, b->keyframe, Normalised(a->T_old_new * b->T_old_new.inverse()), {}});
            if (std::string joined = JoinParts(parts, part_of(*a), part_of(*b)); !joined.empty())
                news = std::move(joined);
        }
    return news;
}

// Joins two of the parts (PartsOf) if enough of their common places agree. Returns a message for
// the user.
std::string LoopCloser::JoinParts(std::span<const int> parts, int a, int b) {
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
    if (keyframes_.empty()) return;
    const std::vector<int> parts = PartsOf(edges_, keyframes_.all());
    const auto here = [&parts](int id) {
        return parts[static_cast<std::size_t>(id)] == parts.back();
    };
    if (std::ranges::count_if(passages_, here, &PathPose::keyframe) > kShortPart) return;
    left_out_.resize(parts.size());
    for (int id = 0; id < keyframes_.size(); ++id)
        if (here(id)) left_out_[static_cast<std::size_t>(id)] = true;
}

// Two parts were joined, but are not yet in the map.
bool LoopCloser::PartsMove() const { return MaxDisplacement_m(MapPoses()) > kPartsApart_m / 2; }

// Moves joined parts of a copy of the map to where the graph has them, each as a whole: what else
// has changed is left to the next correction. Where a surface lands on another, that one stays, as
// in a map that is moved.
std::unique_ptr<MapRebuild> LoopCloser::MoveParts(
    const BlockMap& in_use, const std::vector<Eigen::Isometry3d>& graph) const {
    const double block_m = kBlockSide * in_use.config().voxel_size_m;
    const auto in_part = [&](BlockId id, const Eigen::Isometry3d& T_map_camera) {
        const BlockCoord c = in_use.coord(id);
        return InOnePart(
            Eigen::Isometry3d(Eigen::Translation3d(block_m * Eigen::Vector3d(c.x, c.y, c.z))),
            T_map_camera);
    };
    std::unique_ptr<BlockMap> map = CopyLayers(in_use, BlockMap::Layers::kAll);
    std::vector<Eigen::Isometry3d> T_new_keyframe = MapPoses();
    std::vector<BlockCoord> doubtful;
    for (std::size_t k = 0; k < graph.size(); ++k) {
        if (InOnePart(T_new_keyframe[k], graph[k])) continue;
        const Eigen::Isometry3d T_old = T_new_keyframe[k],
                                T_new_old = Normalised(graph[k] * T_old.inverse());
        for (Eigen::Isometry3d& T : T_new_keyframe)
            if (InOnePart(T, T_old)) T = Normalised(T_new_old * T);
        std::vector<BlockId> blocks;
        for (BlockId id = 1; id < in_use.size(); ++id) {
            if (in_use.IsFree(id) || !in_part(id, T_old)) continue;
            blocks.push_back(id);
            map->Release(id);
        }
        BlockMover mover = MoveRigidly(in_use, blocks, T_new_old, settings_.fusion.volume.box());
        while (!mover.Step(*map, 0)) continue;
        const std::set<BlockId> added(mover.added().begin(), mover.added().end());
        for (const BlockId id : mover.moved())
            if (!added.contains(id)) doubtful.push_back(map->coord(id));
    }
    for (BlockId id = 1; id < map->size(); ++id) map->MarkChanged(id, 0);
    return std::make_unique<MapRebuild>(settings_, std::move(T_new_keyframe), std::move(map),
                                        std::move(doubtful));
}

// At the end: parts that were not joined are left out, but for the one with most frames in the map.
// Its first keyframe's camera is then that of the world. Returns a message for the user, empty if
// there is only one.
std::string LoopCloser::KeepLargestPart() {
    const std::vector<int> parts = PartsOf(edges_, keyframes_.all());
    std::vector<int> fused(parts.size(), 0);  // by keyframe
    for (const PathPose& p : passages_) fused[static_cast<std::size_t>(p.keyframe)] += p.fused;
    left_out_ = OutsideTheLargest(parts, fused);
    if (left_out_.empty()) return {};
    const auto kept = std::ranges::find(left_out_, false) - left_out_.begin();
    if (kept != 0) {
        const Eigen::Isometry3d T_first_world =
            keyframes_[static_cast<int>(kept)].T_world_camera.inverse();
        for (int id = 0; id < keyframes_.size(); ++id)
            keyframes_[id].T_world_camera =
                Normalised(T_first_world * keyframes_[id].T_world_camera);
    }
    corrected_ = true;
    const auto frames =
        std::ranges::count_if(passages_, [this](const PathPose& p) { return LeftOut(p.keyframe); });
    const auto others = std::set<int>(parts.begin(), parts.end()).size() - 1;
    return fmt::format("{} frames are left out, as nothing joins {} with the rest of the scan",
                       frames, others == 1 ? "their part" : fmt::format("their {} parts", others));
}

}  // namespace tessera
