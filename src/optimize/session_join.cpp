#include "optimize/session_join.h"

#include <algorithm>
#include <iterator>
#include <limits>
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
    for (Keyframe& keyframe : b.graph.keyframes) {
        keyframe.id += first;
        keyframe.T_map_camera = Normalised(pose.T_a_b * keyframe.T_map_camera);
        keyframe.T_world_camera = Normalised(pose.T_a_b * keyframe.T_world_camera);
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
    for (const CommonPlace& place : pose.places) {
        a.graph.edges.push_back(EdgeAt(place));
        a.graph.edges.back().to += first;
    }
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
