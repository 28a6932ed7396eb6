// What a new keyframe shows to LoopCloser: that it closes a loop, that tracking has drifted, or
// that it belongs to two parts of the scan.
#include <fmt/format.h>

#include <algorithm>

#include "core/se3.h"
#include "optimize/loop_closer.h"
#include "optimize/shown_drift.h"

namespace tessera {
namespace {

std::string ClosedText(const Keyframe& old, const Drift& drift) {
    return fmt::format("loop closed with frame {}: {:.1f} cm and {:.1f} degrees off",
                       old.frame_index, 100 * drift.off_m, drift.off_rad * 57.29578);
}

}  // namespace

std::string LoopCloser::SeekLoop(const Keyframe& fresh, const PreparedFrame& prepared,
                                 const FrameMotion& motion) {
    const std::optional<PlaceFinder::Loop> loop = places_.FindLoop(fresh, prepared, motion);
    return loop ? CloseLoop(graph_.keyframes()[loop->old], fresh, loop->verdict) : std::string();
}

// Keeps the tracked pose if tracking has already closed the loop: the full map is more accurate
// than two frames.
std::string LoopCloser::CloseLoop(const Keyframe& old, const Keyframe& fresh,
                                  const FieldVerdict& verdict) {
    const Eigen::Isometry3d T_old_new =
        verdict.closed_before ? Normalised(old.T_map_camera.inverse() * fresh.T_map_camera)
                              : verdict.T_old_new;
    graph_.AddLoop(old.id, fresh.id, T_old_new);
    const Drift drift = DriftOf(old, fresh, T_old_new, config_.max_drift);
    if (drift.off_m < config_.min_correction_m && drift.off_rad < config_.min_correction_m)
        return {};
    if (Status solved = graph_.Optimise(); !solved.ok()) return solved.message();
    graph_.MarkCorrected();
    if (Status solved = graph_.OptimiseAgain(); !solved.ok()) return solved.message();
    return ClosedText(old, drift);
}

// Corrects the path if direct alignment shows that tracking is off.
std::string LoopCloser::SeekDrift() {
    const Keyframes& keyframes = graph_.keyframes();
    const std::optional<double> factor = AlignedFactor(keyframes);
    if (!factor) return {};
    // The map would not show less.
    const double least_m = settings_.map.voxel_size_m;
    const ShownDrift shown = FindShownDrift(keyframes, *factor, least_m, config_.max_drift);
    if (!shown.worth_a_solution) return {};
    const bool first = !graph_.corrected();
    if (first) {
        const std::vector<Eigen::Isometry3d> before = graph_.Poses();
        if (Status solved = graph_.Optimise(); !solved.ok()) return solved.message();
        if (graph_.Displacement_m(before) < least_m) {
            graph_.SetPoses(before);  // nothing that matters: tracking is more accurate
            return {};
        }
        graph_.MarkCorrected();
        graph_.CountLoop();
    }
    if (Status solved = graph_.OptimiseAgain(); !solved.ok()) return solved.message();
    return first ? ClosedText(*shown.old, shown.drift) : std::string();
}

// Looks for a keyframe among those of other parts.
std::string LoopCloser::SeekOtherParts(const Keyframe& fresh, const PreparedFrame& prepared) {
    const std::vector<int> parts = graph_.Parts();
    if (std::ranges::count(parts, 0) == std::ssize(parts)) return {};
    const auto elsewhere = [&parts, here = parts.back()](int id) {
        return parts[static_cast<std::size_t>(id)] != here;
    };
    std::string ignored;
    std::vector<PlaceFinder::Place> places = places_.BestOfParts(
        {fresh.features, graph_.overlaps().ViewOf(fresh), prepared}, elsewhere, ignored);
    places.push_back({fresh.id, Eigen::Isometry3d::Identity(), fresh.T_map_camera, 0});
    return joiner_.JoinAt(places);
}

}  // namespace tessera
