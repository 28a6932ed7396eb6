#include "optimize/part_joiner.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/se3.h"

namespace tessera {

std::string PartJoiner::JoinAt(const std::vector<PlaceFinder::Place>& places) {
    std::string news;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const std::vector<int> parts = graph_.Parts();
            const auto part_of = [&parts](const PlaceFinder::Place& place) {
                return parts[static_cast<std::size_t>(place.keyframe)];
            };
            const PlaceFinder::Place *a = &places[i], *b = &places[k];
            if (part_of(*a) == part_of(*b)) continue;
            if (part_of(*a) > part_of(*b)) std::swap(a, b);  // the part that began later moves
            common_.push_back(
                {a->keyframe, b->keyframe, Normalised(a->T_old_new * b->T_old_new.inverse()), {}});
            if (std::string joined = Join(parts, part_of(*a), part_of(*b)); !joined.empty())
                news = std::move(joined);
        }
    return news;
}

// Joins two of the parts (ScanGraph::Parts) if enough of their common places agree. Returns a
// message for the user.
std::string PartJoiner::Join(std::span<const int> parts, int a, int b) {
    const Keyframes& keyframes = graph_.keyframes();
    const auto between = [&](const CommonPlace& place) {
        return parts[static_cast<std::size_t>(place.in_a)] == a &&
               parts[static_cast<std::size_t>(place.in_b)] == b;
    };
    std::vector<CommonPlace> places;
    for (CommonPlace& place : common_) {
        // Since then the later one may have been joined to an earlier one than the other.
        if (parts[static_cast<std::size_t>(place.in_a)] == b) {
            std::swap(place.in_a, place.in_b);
            place.T_in_a_in_b = Normalised(place.T_in_a_in_b.inverse());
        }
        if (!between(place)) continue;
        place.T_world_a_in_b = keyframes[place.in_a].T_world_camera * place.T_in_a_in_b;
        places.push_back(place);
    }
    const std::optional<JointPose> joint = AgreeOnPose(places, keyframes.all());
    if (!joint) return {};
    std::erase_if(common_, between);
    if (Status solved = graph_.Join(parts, b, *joint); !solved.ok()) return solved.message();
    return fmt::format(
        "the part of the scan that began at frame {} is joined with that of frame {}",
        keyframes[b].frame_index, keyframes[a].frame_index);
}

}  // namespace tessera
