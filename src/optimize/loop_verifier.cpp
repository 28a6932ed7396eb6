#include "optimize/loop_verifier.h"

#include <algorithm>

#include "core/se3.h"

namespace tessera {
namespace {

// Metres and radians. So far nothing else of the same kind is mistaken for a place: doors and racks
// repeat at a metre and more.
constexpr double kAlways = 0.15;

}  // namespace

Drift DriftOf(const Keyframe& old, const Keyframe& fresh, const Eigen::Isometry3d& T_old_new,
              double max_drift) {
    constexpr double kApart_m = 0.8, kApart_rad = 0.35;
    const Eigen::Isometry3d T_old_estimate = old.T_world_camera.inverse() * fresh.T_world_camera;
    Drift drift;
    drift.off_m = (T_old_estimate.translation() - T_old_new.translation()).norm();
    drift.off_rad = RotationAngle(T_old_estimate, T_old_new);
    const double share_m = max_drift * (fresh.path_length_m - old.path_length_m),
                 share_rad = max_drift * (fresh.turned_rad - old.turned_rad);
    drift.possible = drift.off_m <= kAlways + share_m && drift.off_rad <= kAlways + share_rad;
    drift.conceivable =
        drift.off_m <= kApart_m + share_m && drift.off_rad <= kApart_rad + share_rad;
    return drift;
}

LoopVerifier::Match LoopVerifier::MatchKeyframes(const Keyframe& old, const Keyframe& fresh) const {
    const std::optional<Eigen::Isometry3d> T_old_new =
        MatchFeatures(old.features, fresh.features, config_);
    if (!T_old_new) return {};
    const Drift drift = DriftOf(old, fresh, *T_old_new, config_.max_drift);
    if (!drift.conceivable) return {};
    return {T_old_new, !drift.possible || drift.off_m > kAlways};
}

FieldVerdict LoopVerifier::VerifyLoop(const Keyframes& keyframes, const Keyframe& old,
                                      const Keyframe& fresh, const Eigen::Isometry3d& T_old_new,
                                      const PreparedFrame& prepared, const FrameMotion& motion,
                                      FrameStore& store) {
    const Eigen::Isometry3d T_old_new_expected = old.T_map_camera.inverse() * fresh.T_map_camera;
    if (NothingToCorrect(T_old_new, T_old_new_expected)) {
        FieldVerdict closed;
        closed.accepted = closed.closed_before = true;
        closed.T_old_new = T_old_new_expected;
        return closed;
    }
    return field_.Check(FramesNear(keyframes, old.id, store),
                        {prepared, motion, T_old_new, T_old_new_expected}, store);
}

// Features and map agree so well that the field check, which costs a hundred times as much, could
// not correct anything.
bool LoopVerifier::NothingToCorrect(const Eigen::Isometry3d& T_measured,
                                    const Eigen::Isometry3d& T_expected) const {
    return (T_measured.translation() - T_expected.translation()).norm() <
               config_.min_correction_m &&
           RotationAngle(T_measured, T_expected) < config_.min_correction_m;
}

FieldVerdict LoopVerifier::VerifyPlace(const Keyframes& keyframes, const Keyframe& old,
                                       const PreparedFrame& fresh,
                                       const Eigen::Isometry3d& T_old_new, FrameStore& store) {
    return field_.Check(FramesNear(keyframes, old.id, store), {fresh, {}, T_old_new, std::nullopt},
                        store);
}

// The keyframe's own frame first, then an even sample of frames of it and its two neighbours. Empty
// if its own is not stored.
std::vector<NearFrame> LoopVerifier::FramesNear(const Keyframes& keyframes, int keyframe,
                                                const FrameStore& store) const {
    constexpr std::size_t kMost = 4;
    const std::vector<StoredFrame>& all = store.frames();
    std::vector<NearFrame> near(1), others;
    const Eigen::Isometry3d T_keyframe_world = keyframes[keyframe].T_map_camera.inverse();
    auto frame = std::ranges::lower_bound(all, keyframe - 1, {}, &StoredFrame::keyframe);
    for (; frame != all.end() && frame->keyframe <= keyframe + 1; ++frame) {
        const bool own = frame->keyframe == keyframe && frame->is_keyframe;
        const Eigen::Isometry3d T_keyframe_camera =
            T_keyframe_world * keyframes[frame->keyframe].T_map_camera * frame->T_keyframe_camera;
        // Tracking may have been lost between two keyframes.
        if (T_keyframe_camera.translation().norm() > 0.5) continue;
        if (own)
            near.front() = {&*frame, T_keyframe_camera};
        else
            others.push_back({&*frame, T_keyframe_camera});
    }
    if (near.front().stored == nullptr) return {};
    const std::size_t step = std::max<std::size_t>(1, (others.size() + kMost - 1) / kMost);
    for (std::size_t i = 0; i < others.size(); i += step) near.push_back(others[i]);
    return near;
}

}  // namespace tessera
