// Where a lost camera is, of LoopCloser: by features, then by direct alignment with what the
// keyframe saw.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/se3.h"
#include "optimize/loop_closer.h"
#include "optimize/texture_correlation.h"

namespace tessera {
namespace {

constexpr double kApart_m = 0.3, kApart_rad = 0.3;  // farther apart: two places

bool SamePlace(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return (a.translation() - b.translation()).norm() <= kApart_m &&
           RotationAngle(a, b) <= kApart_rad;
}

}  // namespace

// All places where features agree on a pose and the view fits what a keyframe there saw: its depth,
// and more than half of the variance of its fine texture.
std::vector<LoopCloser::Place> LoopCloser::PlacesOf(const Features& features, const DenseView& view,
                                                    const Allows& allows) {
    // Factor compared with a loop: no prior pose narrows down the search.
    constexpr int kManyCandidates = 4;
    int left = kManyCandidates * config_.candidates;
    std::vector<Place> places;
    for (const auto& candidate : index_.Query(features.descriptors, keyframes_.size(),
                                              keyframes_.size(), config_.min_votes)) {
        if (LeftOut(candidate.keyframe) || !allows(candidate.keyframe)) continue;
        if (--left < 0) break;
        const Keyframe& old = keyframes_[candidate.keyframe];
        const FeatureMatch match = MatchFeatures(old.features, features, config_);
        if (!match.accepted) continue;
        const Eigen::Isometry3d T_map_guess = old.T_map_camera * match.T_old_new;
        if (std::ranges::any_of(places, [&](const Place& place) {
                return SamePlace(place.T_map_camera, T_map_guess);
            }))
            continue;
        const ViewAlignment aligned = overlaps_.AlignView(old, view, match.T_old_new);
        if (!aligned.converged || aligned.overlap < config_.min_known_fraction ||
            aligned.fit < config_.min_fit ||
            !SameTexture(overlaps_.ViewOf(old), view, aligned.T_a_b))
            continue;
        places.push_back({old.id, aligned.T_a_b, old.T_map_camera * aligned.T_a_b, 0});
    }
    return places;
}

// Asks the field, which looks more closely, which of several places explains the view best. Returns
// null if none does so much better than all others.
const LoopCloser::Place* LoopCloser::BestOf(std::vector<Place>& places, const PreparedFrame& frame,
                                            std::string& note) {
    constexpr double kAsWell = 0.6;
    if (places.size() > 1) {
        for (Place& place : places) {
            const FieldVerdict verdict = verifier_.VerifyPlace(
                keyframes_, keyframes_[place.keyframe], frame, place.T_old_new, store_);
            place.explained = verdict.accepted ? verdict.explained : 0;
        }
        std::erase_if(places, [](const Place& place) { return place.explained <= 0; });
        std::ranges::stable_sort(places, std::greater{}, &Place::explained);
    }
    if (places.empty()) return nullptr;
    const Place& best = places.front();
    if (places.size() == 1 || places[1].explained < kAsWell * best.explained) return &best;
    note =
        fmt::format("ambiguous place: frame {} or frame {}", keyframes_[best.keyframe].frame_index,
                    keyframes_[places[1].keyframe].frame_index);
    return nullptr;
}

// The best of the allowed places in each part of the scan that has one.
std::vector<LoopCloser::Place> LoopCloser::BestOfParts(const Features& features,
                                                       const DenseView& view,
                                                       const PreparedFrame& frame,
                                                       const Allows& allows, std::string& note) {
    std::vector<Place> places = PlacesOf(features, view, allows), best;
    while (!places.empty()) {
        const Eigen::Isometry3d T_map_first = places.front().T_map_camera;
        const auto others = std::stable_partition(
            places.begin(), places.end(),
            [&](const Place& place) { return InOnePart(place.T_map_camera, T_map_first); });
        std::vector<Place> here(places.begin(), others);
        places.erase(places.begin(), others);
        if (const Place* place = BestOf(here, frame, note)) best.push_back(*place);
    }
    return best;
}

std::optional<Eigen::Isometry3d> LoopCloser::Relocalise(
    const PreparedFrame& frame, std::string& note,
    const std::optional<Eigen::Isometry3d>& T_map_expected) {
    relocalised_at_.reset();
    const Features features = ExtractFeatures(frame, settings_.camera, config_.max_features);
    const DenseView view =
        MakeDenseView(MakeReducedView(frame, settings_.camera, {}), settings_.camera);
    const std::vector<Place> places = BestOfParts(
        features, view, frame,
        [&](int id) {
            return !T_map_expected || InOnePart(keyframes_[id].T_map_camera, *T_map_expected);
        },
        note);
    if (places.empty()) return std::nullopt;
    const Place& best = *std::ranges::max_element(
        places, {}, [this](const Place& place) { return KeyframesAround(place.T_map_camera); });
    relocalised_at_ = best.keyframe;
    note = fmt::format("relocalised at frame {}", keyframes_[best.keyframe].frame_index);
    if (std::string joined = JoinAt(places); !joined.empty()) note += "; " + joined;
    keyframes_.Jump();
    jumps_.Reset();
    return Normalised(best.T_map_camera);
}

}  // namespace tessera
