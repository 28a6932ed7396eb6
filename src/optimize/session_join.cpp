#include "optimize/session_join.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "core/se3.h"

namespace tessera {
namespace {

int NearestKeyframe(const Keyframes& keyframes, const Eigen::Isometry3d& T_map_camera) {
    int nearest = 0;
    double least = std::numeric_limits<double>::max();
    for (int id = 0; id < keyframes.size(); ++id) {
        const double off =
            (keyframes[id].T_map_camera.translation() - T_map_camera.translation()).norm() +
            RotationAngle(keyframes[id].T_map_camera, T_map_camera);
        if (off < least) std::tie(least, nearest) = std::pair(off, id);
    }
    return nearest;
}

// Moves a part, whose first keyframe this is, to where none of these keyframes is.
Eigen::Isometry3d ToAFreePlace(const Keyframe& first, std::span<const Keyframe> keyframes) {
    const auto taken = [&](int part) {
        return std::ranges::any_of(keyframes, [&](const Keyframe& keyframe) {
            return InOnePart(keyframe.T_map_camera, PartStart(part)) ||
                   InOnePart(keyframe.T_world_camera, PartStart(part));
        });
    };
    int part = 1;
    while (taken(part)) ++part;
    return Eigen::Isometry3d(
        Eigen::Translation3d(PartStart(part).translation() - first.T_world_camera.translation()));
}

}  // namespace

std::vector<CommonPlace> FindCommonPlaces(LoopCloser& a, std::span<const StoredFrame> frames,
                                          const FieldSettings& settings, double depth_units_per_m) {
    FrameStore loader(std::numeric_limits<std::size_t>::max(), depth_units_per_m);
    std::vector<CommonPlace> places;
    Frame frame;
    PreparedFrame prepared;
    std::string ignored;
    for (const StoredFrame& stored : frames) {
        if (!stored.is_keyframe ||
            !loader.LoadPrepared(stored, settings.camera, settings.preparation, frame, prepared)
                 .ok())
            continue;
        const std::optional<FoundCamera> found = a.Relocalise(frame.stamp_s, prepared, ignored);
        if (!found) continue;
        const int nearest = NearestKeyframe(a.keyframes(), found->T_map_camera);
        const Keyframe& in_a = a.keyframes()[nearest];
        const Eigen::Isometry3d T_in_a_in_b =
            Normalised(in_a.T_map_camera.inverse() * found->T_map_camera);
        places.push_back(
            {nearest, stored.keyframe, T_in_a_in_b, Normalised(in_a.T_world_camera * T_in_a_in_b)});
    }
    return places;
}

void AppendSession(LoopCloser::Memory b, const JointPose& pose, LoopCloser::Memory& a) {
    const int first = static_cast<int>(a.graph.keyframes.size());
    const double way_m = a.graph.keyframes.empty() ? 0 : a.graph.keyframes.back().path_length_m,
                 turned_rad = a.graph.keyframes.empty() ? 0 : a.graph.keyframes.back().turned_rad;
    const std::vector<int> parts = PartsOf(b.graph.edges, b.graph.keyframes);
    const auto part_of = [&](int id) { return parts[static_cast<std::size_t>(id)]; };
    std::map<int, Eigen::Isometry3d> T_a_part;  // where b's parts go
    for (const CommonPlace& place : pose.places) T_a_part[part_of(place.in_b)] = pose.T_a_b;
    for (Keyframe& keyframe : b.graph.keyframes) {
        const int part = part_of(keyframe.id);
        if (!T_a_part.contains(part)) T_a_part[part] = ToAFreePlace(keyframe, a.graph.keyframes);
        keyframe.id += first;
        keyframe.T_map_camera = Normalised(T_a_part[part] * keyframe.T_map_camera);
        keyframe.T_world_camera = Normalised(T_a_part[part] * keyframe.T_world_camera);
        keyframe.path_length_m += way_m;
        keyframe.turned_rad += turned_rad;
        for (Overlap& overlap : keyframe.overlaps) overlap.with += first;
        a.graph.keyframes.push_back(std::move(keyframe));
    }
    for (PoseEdge& edge : b.graph.edges) {
        edge.from += first;
        edge.to += first;
        a.graph.edges.push_back(std::move(edge));
    }
    for (const CommonPlace& place : pose.places)
        a.graph.edges.push_back(LoopEdge(place.in_a, place.in_b + first, place.T_in_a_in_b));
    for (PathPose& passage : b.graph.passages) {
        passage.keyframe += first;
        a.graph.passages.push_back(passage);
    }
    for (StoredFrame& frame : b.frames) {
        frame.keyframe += first;
        frame.ordinal += a.next_ordinal;
        a.frames.push_back(std::move(frame));
    }
    a.next_ordinal += b.next_ordinal;
    a.graph.loops += b.graph.loops + 1;
    a.graph.corrected = true;
}

}  // namespace tessera
