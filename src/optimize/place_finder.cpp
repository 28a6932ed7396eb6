#include "optimize/place_finder.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/se3.h"
#include "optimize/texture_correlation.h"

namespace tessera {
namespace {

constexpr double kApart_m = 0.3, kApart_rad = 0.3;  // farther apart: two places

bool SamePlace(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return (a.translation() - b.translation()).norm() <= kApart_m &&
           RotationAngle(a, b) <= kApart_rad;
}

// True if direct alignment has already found the place: the field check, which costs a hundred
// times as much, would say the same.
bool Aligned(const Keyframe& fresh, const Keyframe& old) {
    constexpr int kBeside = 2;
    return std::ranges::any_of(fresh.overlaps, [&](const Overlap& overlap) {
        return std::abs(overlap.with - old.id) <= kBeside;
    });
}

}  // namespace

// All places where features agree on a pose and the view fits what a keyframe there saw: its depth,
// and more than half of the variance of its fine texture.
std::vector<PlaceFinder::Place> PlaceFinder::PlacesOf(const View& view, const Allows& allows) {
    // Factor compared with a loop: no prior pose narrows down the search.
    constexpr int kManyCandidates = 4;
    const Keyframes& keyframes = graph_.keyframes();
    int left = kManyCandidates * config_.candidates;
    std::vector<Place> places;
    for (const auto& candidate : index_.Query(view.features.descriptors, keyframes.size(),
                                              keyframes.size(), config_.min_votes)) {
        if (graph_.LeftOut(candidate.keyframe) || !allows(candidate.keyframe)) continue;
        if (--left < 0) break;
        const Keyframe& old = keyframes[candidate.keyframe];
        const std::optional<Eigen::Isometry3d> T_old_new =
            MatchFeatures(old.features, view.features, config_);
        if (!T_old_new) continue;
        const Eigen::Isometry3d T_map_guess = old.T_map_camera * *T_old_new;
        if (std::ranges::any_of(places, [&](const Place& place) {
                return SamePlace(place.T_map_camera, T_map_guess);
            }))
            continue;
        const ViewAlignment aligned = graph_.overlaps().AlignView(old, view.dense, *T_old_new);
        if (!aligned.converged || aligned.overlap < config_.min_known_fraction ||
            aligned.fit < config_.min_fit ||
            !SameTexture(graph_.overlaps().ViewOf(old), view.dense, aligned.T_a_b))
            continue;
        places.push_back({old.id, aligned.T_a_b, old.T_map_camera * aligned.T_a_b, 0});
    }
    return places;
}

// Asks the field, which looks more closely, which of several places explains the view best. Returns
// null if none does so much better than all others.
const PlaceFinder::Place* PlaceFinder::BestOf(std::vector<Place>& places,
                                              const PreparedFrame& frame, std::string& note) {
    constexpr double kAsWell = 0.6;
    const Keyframes& keyframes = graph_.keyframes();
    if (places.size() > 1) {
        for (Place& place : places) {
            const FieldVerdict verdict = verifier_.VerifyPlace(keyframes, keyframes[place.keyframe],
                                                               frame, place.T_old_new, store_);
            place.explained = verdict.accepted ? verdict.explained : 0;
        }
        std::erase_if(places, [](const Place& place) { return place.explained <= 0; });
        std::ranges::stable_sort(places, std::greater{}, &Place::explained);
    }
    if (places.empty()) return nullptr;
    const Place& best = places.front();
    if (places.size() == 1 || places[1].explained < kAsWell * best.explained) return &best;
    note =
        fmt::format("ambiguous place: frame {} or frame {}", keyframes[best.keyframe].frame_index,
                    keyframes[places[1].keyframe].frame_index);
    return nullptr;
}

std::vector<PlaceFinder::Place> PlaceFinder::BestOfParts(const View& view, const Allows& allows,
                                                         std::string& note) {
    std::vector<Place> places = PlacesOf(view, allows), best;
    while (!places.empty()) {
        const Eigen::Isometry3d T_map_first = places.front().T_map_camera;
        const auto others = std::stable_partition(
            places.begin(), places.end(),
            [&](const Place& place) { return InOnePart(place.T_map_camera, T_map_first); });
        std::vector<Place> here(places.begin(), others);
        places.erase(places.begin(), others);
        if (const Place* place = BestOf(here, view.prepared, note)) best.push_back(*place);
    }
    return best;
}

std::optional<PlaceFinder::Loop> PlaceFinder::FindLoop(const Keyframe& fresh,
                                                       const PreparedFrame& prepared,
                                                       const FrameMotion& motion) {
    Keyframes& keyframes = graph_.keyframes();
    const auto candidates = index_.Query(fresh.features.descriptors, fresh.id - config_.min_gap,
                                         config_.candidates, config_.min_votes);
    const bool errors_known = AlignedFactor(keyframes).has_value();
    for (const PlaceIndex::Candidate& candidate : candidates) {
        const Keyframe& old = keyframes[candidate.keyframe];
        if (errors_known && Aligned(fresh, old)) continue;
        const LoopVerifier::Match match = verifier_.MatchKeyframes(old, fresh);
        if (!match.T_old_new ||
            (match.ask_for_texture && !ShowTheSame(old, fresh, *match.T_old_new)))
            continue;
        if (errors_known) {
            graph_.overlaps().Align(keyframes, fresh.id, old.id, *match.T_old_new, true);
            continue;
        }
        const FieldVerdict verdict =
            verifier_.VerifyLoop(keyframes, old, fresh, *match.T_old_new, prepared, motion, store_);
        if (verdict.accepted) return Loop{old.id, verdict};
    }
    return std::nullopt;
}

bool PlaceFinder::ShowTheSame(const Keyframe& old, const Keyframe& fresh,
                              const Eigen::Isometry3d& T_old_new) {
    if (fresh.reduced.empty()) return false;
    OverlapFinder& overlaps = graph_.overlaps();
    const DenseView& view = overlaps.ViewOf(fresh);
    const ViewAlignment aligned = overlaps.AlignView(old, view, T_old_new);
    return aligned.converged && SameTexture(overlaps.ViewOf(old), view, aligned.T_a_b);
}

}  // namespace tessera
