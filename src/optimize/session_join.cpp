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

Eigen::Isometry3d WorldsOf(const CommonPlace& place, const Keyframe& in_b) {
    return Normalised(place.T_world_a_in_b * in_b.T_world_camera.inverse());
}

bool ShareLittle(const Keyframe& a, const Keyframe& b) {
    constexpr double kLittle = 0.5;
    return ViewOverlap(b.depth_m, b.view,
                       Normalised(a.T_world_camera.inverse() * b.T_world_camera)) < kLittle;
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
        const auto T_map_camera = a.Relocalise(prepared, ignored);
        if (!T_map_camera) continue;
        const int nearest = NearestKeyframe(a.keyframes(), *T_map_camera);
        const Keyframe& in_a = a.keyframes()[nearest];
        const Eigen::Isometry3d T_in_a_in_b =
            Normalised(in_a.T_map_camera.inverse() * *T_map_camera);
        places.push_back(
            {nearest, stored.keyframe, T_in_a_in_b, Normalised(in_a.T_world_camera * T_in_a_in_b)});
    }
    return places;
}

std::optional<JointPose> AgreeOnPose(std::span<const CommonPlace> places,
                                     std::span<const Keyframe> keyframes_of_b) {
    constexpr double kNear_m = 0.15, kNear_rad = 0.15, kDrift = 0.05;  // as for a loop (DriftOf)
    const auto in_b = [&](const CommonPlace& place) -> const Keyframe& {
        return keyframes_of_b[static_cast<std::size_t>(place.in_b)];
    };
    JointPose best;
    for (const CommonPlace& start : places) {
        const Eigen::Isometry3d T_a_b = WorldsOf(start, in_b(start));
        JointPose pose{T_a_b, {}};
        for (const CommonPlace& place : places) {
            const Eigen::Isometry3d T_world_a_expected = T_a_b * in_b(place).T_world_camera;
            const double way_m = std::abs(in_b(place).path_length_m - in_b(start).path_length_m);
            if ((T_world_a_expected.translation() - place.T_world_a_in_b.translation()).norm() <=
                    kNear_m + kDrift * way_m &&
                RotationAngle(T_world_a_expected, place.T_world_a_in_b) <=
                    kNear_rad + kDrift * std::abs(in_b(place).turned_rad - in_b(start).turned_rad))
                pose.places.push_back(place);
        }
        if (pose.places.size() > best.places.size()) best = std::move(pose);
    }
    for (const CommonPlace& a : best.places)
        for (const CommonPlace& b : best.places)
            if (ShareLittle(in_b(a), in_b(b))) return best;
    return std::nullopt;
}

void AppendSession(LoopCloser::Memory b, const JointPose& pose, LoopCloser::Memory& a) {
    constexpr double kSigma_m = 0.01, kSigma_rad = 0.005;  // of a place
    const int first = static_cast<int>(a.keyframes.size());
    const double way_m = a.keyframes.empty() ? 0 : a.keyframes.back().path_length_m,
                 turned_rad = a.keyframes.empty() ? 0 : a.keyframes.back().turned_rad;
    for (Keyframe& keyframe : b.keyframes) {
        keyframe.id += first;
        keyframe.T_map_camera = Normalised(pose.T_a_b * keyframe.T_map_camera);
        keyframe.T_world_camera = Normalised(pose.T_a_b * keyframe.T_world_camera);
        keyframe.path_length_m += way_m;
        keyframe.turned_rad += turned_rad;
        for (Overlap& overlap : keyframe.overlaps) overlap.with += first;
        a.keyframes.push_back(std::move(keyframe));
    }
    for (PoseEdge& edge : b.edges) {
        edge.from += first;
        edge.to += first;
        a.edges.push_back(std::move(edge));
    }
    for (const CommonPlace& place : pose.places)
        a.edges.push_back({place.in_a, place.in_b + first, place.T_in_a_in_b,
                           RootInformation(kSigma_rad, kSigma_m), true});
    for (LoopCloser::PathPose& passage : b.passages) {
        passage.keyframe += first;
        a.passages.push_back(passage);
    }
    for (StoredFrame& frame : b.frames) {
        frame.keyframe += first;
        frame.ordinal += a.next_ordinal;
        a.frames.push_back(std::move(frame));
    }
    a.next_ordinal += b.next_ordinal;
    a.loops += b.loops + 1;
    a.corrected = true;
}

}  // namespace tessera
