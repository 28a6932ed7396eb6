#include "optimize/field_check.h"

#include <cmath>

#include "mapping/field_sampler.h"

namespace tessera {

FieldCheck::FieldCheck(const FieldSettings& settings, const LoopConfig& config)
    : settings_(settings),
      config_(config),
      map_(settings.map),
      integrator_(settings.fusion, settings.camera),
      model_(settings.photometric),
      tracker_(settings.tracker, settings.camera, TrackJudge(settings.judge), model_, true) {}

FieldVerdict FieldCheck::Check(std::span<const NearFrame> old_frames, const FreshFrame& fresh,
                               FrameStore& store) {
    constexpr double kAsWell = 0.9;
    FieldVerdict verdict;
    if (old_frames.empty()) return verdict;
    FuseOld(old_frames, store);
    const TrackResult forward = Track(fresh.prepared, fresh.motion, fresh.T_old_new_features);
    verdict.T_old_new = forward.T_world_camera;
    if (!Fits(forward)) return verdict;
    verdict.closed_before = fresh.T_old_new_expected &&
                            InlierShare(fresh.prepared, *fresh.T_old_new_expected) >=
                                kAsWell * InlierShare(fresh.prepared, forward.T_world_camera);

    map_.Clear();
    Integrator::View view;
    view.motion = fresh.motion;
    integrator_.Integrate(fresh.prepared, view, map_);
    const StoredFrame& old = *old_frames.front().stored;
    if (!Load(old, store)) return verdict;
    const TrackResult backward =
        Track(prepared_, old.view.motion, forward.T_world_camera.inverse());
    if (!Fits(backward)) return verdict;
    verdict.explained = std::min(forward.known_fraction * forward.inlier_fraction,
                                 backward.known_fraction * backward.inlier_fraction);
    const Eigen::Isometry3d disagreement = forward.T_world_camera * backward.T_world_camera;
    const double off_m = disagreement.translation().norm();
    const double off_rad = RotationAngle(disagreement, Eigen::Isometry3d::Identity());
    verdict.accepted = off_m <= config_.max_disagreement_m && off_rad <= config_.max_disagreement_m;
    return verdict;
}

bool FieldCheck::Load(const StoredFrame& stored, FrameStore& store) {
    return store.LoadPrepared(stored, settings_.camera, settings_.preparation, frame_, prepared_)
        .ok();
}

void FieldCheck::FuseOld(std::span<const NearFrame> frames, FrameStore& store) {
    map_.Clear();
    for (const NearFrame& frame : frames) {
        if (!Load(*frame.stored, store)) continue;
        Integrator::View view = frame.stored->view;
        view.T_world_camera = frame.T_keyframe_camera;
        integrator_.Integrate(prepared_, view, map_);
    }
}

TrackResult FieldCheck::Track(const PreparedFrame& frame, const FrameMotion& motion,
                              const Eigen::Isometry3d& T_field_camera) {
    model_.Reset();
    return tracker_.Track({.frame = frame,
                           .map = map_,
                           .T_world_camera_starts = {T_field_camera},
                           .T_world_camera_last = T_field_camera,
                           .since_last_s = 0,
                           .motion = motion});
}

// Share of the points inside the known field that lie within half the band of its surface.
double FieldCheck::InlierShare(const PreparedFrame& frame,
                               const Eigen::Isometry3d& T_field_camera) const {
    constexpr int kStep = 8;
    FieldSampler sampler(map_.view(), BlockCoord{0, 0, 0});
    const double per_voxel = 1 / settings_.map.voxel_size_m;
    const TruncationBand band = settings_.map.band();
    int known = 0, fit = 0;
    for (int y = kStep / 2; y < frame.depth_m.height(); y += kStep)
        for (int x = kStep / 2; x < frame.depth_m.width(); x += kStep) {
            const float z = frame.depth_m(x, y);
            if (z <= 0) continue;
            const Eigen::Vector3f p =
                ((T_field_camera * settings_.camera.Unproject(x, y, z)) * per_voxel).cast<float>();
            const FieldSample sample = sampler.Sample<false>(sampler.Locate(p.x(), p.y(), p.z()));
            if (!sample.has_distance) continue;
            ++known;
            fit += std::abs(sample.distance.value) < 0.5f * band.At(z);
        }
    return known > 0 ? static_cast<double>(fit) / known : 0;
}

bool FieldCheck::Fits(const TrackResult& track) const {
    return track.status == TrackStatus::kGood && !track.degenerate &&
           track.known_fraction >= config_.min_known_fraction &&
           track.inlier_fraction >= config_.min_fit;
}

}  // namespace tessera
