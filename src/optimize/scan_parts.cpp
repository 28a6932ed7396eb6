#include "optimize/scan_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/se3.h"
#include "optimize/keyframes.h"

namespace tessera {
namespace {

Eigen::Isometry3d WorldsOf(const CommonPlace& place, const Keyframe& in_b) {
    return Normalised(place.T_world_a_in_b * in_b.T_world_camera.inverse());
}

bool ShareLittle(const Keyframe& a, const Keyframe& b) {
    constexpr double kLittle = 0.5;
    return ViewOverlap(b.depth_m, b.view,
                       Normalised(a.T_world_camera.inverse() * b.T_world_camera)) < kLittle;
}

}  // namespace

std::vector<int> PartsOf(std::span<const PoseEdge> edges, std::span<const Keyframe> keyframes) {
    const int count = static_cast<int>(keyframes.size());
    std::vector<int> first(keyframes.size());
    std::iota(first.begin(), first.end(), 0);
    const auto part_of = [&first](int id) {
        while (first[static_cast<std::size_t>(id)] != id) id = first[static_cast<std::size_t>(id)];
        return id;
    };
    const auto join = [&](int a, int b) {
        const auto [low, high] = std::minmax({part_of(a), part_of(b)});
        first[static_cast<std::size_t>(high)] = low;
    };
    for (const PoseEdge& edge : edges) join(edge.from, edge.to);
    std::vector<int> parts;
    for (int id = 0; id < count; ++id)
        if (part_of(id) == id) parts.push_back(id);
    const auto pose = [&](int id) {
        return keyframes[static_cast<std::size_t>(id)].T_world_camera;
    };
    for (const int a : parts)
        for (const int b : parts)
            if (a < b && InOnePart(pose(a), pose(b))) join(a, b);
    for (int id = 0; id < count; ++id) first[static_cast<std::size_t>(id)] = part_of(id);
    return first;
}

std::vector<bool> OutsideTheLargest(std::span<const int> parts, std::span<const int> frames) {
    std::vector<int> sums(parts.size(), 0);
    for (std::size_t i = 0; i < parts.size(); ++i)
        sums[static_cast<std::size_t>(parts[i])] += frames[i];
    const auto largest = static_cast<int>(std::ranges::max_element(sums) - sums.begin());
    if (std::ranges::count(parts, largest) == std::ssize(parts)) return {};
    std::vector<bool> outside;
    for (const int part : parts) outside.push_back(part != largest);
    return outside;
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

}  // namespace tessera
