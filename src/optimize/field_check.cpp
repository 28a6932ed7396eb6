#include "optimize/field_check.h"

#include <fmt/format.h>

namespace tessera {

FieldCheck::FieldCheck(const FieldSettings& settings, const LoopConfig& config)
    : settings_(settings),
      config_(config),
      map_(settings.map),
      integrator_(settings.fusion, settings.camera),
      photometry_(settings.photometric, settings.camera),
      tracker_(settings.tracker, settings.camera, TrackJudge(settings.judge), &photometry_) {}

FieldVerdict FieldCheck::Check(std::span<const NearFrame> old_frames, const PreparedFrame& fresh,
                               std::span<const NearFrame> new_frames, const Eigen::Isometry3d& T_old_new,
                               FrameStore& store) {
    FieldVerdict verdict;
    map_.Clear();
    Fuse(old_frames, store);
    const TrackResult forward = Track(fresh, T_old_new);
    verdict.T_old_new = forward.T_world_camera;
    if (verdict.reason = Fault(forward); !verdict.reason.empty()) return verdict;

    map_.Clear();
    integrator_.Integrate(fresh, {}, map_);
    Fuse(new_frames, store);
    Load(*old_frames.front().stored, store);
    const TrackResult backward = Track(prepared_, forward.T_world_camera.inverse());
    if (verdict.reason = Fault(backward); !verdict.reason.empty()) {
        verdict.reason = "seen from the other side, " + verdict.reason;
        return verdict;
    }
    const Eigen::Isometry3d disagreement = forward.T_world_camera * backward.T_world_camera;
    const double off_m = disagreement.translation().norm();
    const double off_rad = RotationAngle(disagreement, Eigen::Isometry3d::Identity());
    verdict.accepted = off_m <= config_.max_disagreement_m && off_rad <= config_.max_disagreement_m;
    if (!verdict.accepted)
        verdict.reason = fmt::format("the two sides disagree by {:.3f} m and {:.3f} rad", off_m, off_rad);
    return verdict;
}

void FieldCheck::Load(const StoredFrame& stored, FrameStore& store) {
    const Status loaded = store.Load(stored, frame_);
    TESSERA_CHECK(loaded.ok(), "a frame that was stored cannot be read back: {}", loaded.message());
    PrepareFrame(frame_, settings_.preparation, prepared_);
}

void FieldCheck::Fuse(std::span<const NearFrame> frames, FrameStore& store) {
    for (const NearFrame& frame : frames) {
        Load(*frame.stored, store);
        Integrator::View view = frame.stored->view;
        view.T_world_camera = frame.T_keyframe_camera;
        integrator_.Integrate(prepared_, view, map_);
    }
}

TrackResult FieldCheck::Track(const PreparedFrame& frame, const Eigen::Isometry3d& T_field_camera) {
    photometry_.Reset();
    return tracker_.Track({.frame = frame,
                           .map = map_,
                           .T_world_camera_starts = {T_field_camera},
                           .T_world_camera_last = T_field_camera,
                           .since_last_s = 0,
                           .motion = {}});
}

std::string FieldCheck::Fault(const TrackResult& track) const {
    if (track.status != TrackStatus::kGood) return track.reason;
    if (track.known_fraction < config_.min_known_fraction)
        return fmt::format("only {:.0f} % of the depth lies in the field", 100 * track.known_fraction);
    if (track.inlier_fraction < config_.min_fit)
        return fmt::format("only {:.0f} % of the depth fits the field", 100 * track.inlier_fraction);
    return {};
}

}  // namespace tessera
