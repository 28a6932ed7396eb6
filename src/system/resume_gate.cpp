#include "system/resume_gate.h"

#include "system/lost_camera.h"

namespace tessera {
namespace {

// By more than rounding.
bool Differ(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    constexpr double kRounding = 1e-6;  // metres and radians
    return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() > kRounding;
}

}  // namespace

void ResumeGate::Begin(std::span<const std::uint8_t> saved, const std::optional<StampedPose>& last,
                       TrackingStage& tracking) {
    if (!last) return;
    StateReader state(saved);
    // A part of the scan that had just begun has no pose yet, and must not begin again where the
    // first one did.
    if (!tracking.LoadState(state) || !state.at_end() || !tracking.last()) tracking.StartAt(*last);
    // The map was corrected after the state was saved.
    const StampedPose& loaded = *tracking.last();
    if (loaded.stamp_s == last->stamp_s && Differ(loaded.T_world_camera, last->T_world_camera))
        tracking.Move(last->T_world_camera * loaded.T_world_camera.inverse());
    last_stamp_s_ = last->stamp_s;
    T_world_last_ = last->T_world_camera;
    closed_ = first_ = true;
}

bool ResumeGate::IsThere(const TrackResult& track) const {
    constexpr double kNear_m = 0.3, kNear_rad = 0.4;
    return track.status == TrackStatus::kGood && FitsCompletely(track) &&
           RotationAngle(T_world_last_, track.T_world_camera) <= kNear_rad &&
           (T_world_last_.translation() - track.T_world_camera.translation()).norm() <= kNear_m;
}

void ResumeGate::AfterTracking(const Frame& frame, TrackingStage& tracking, TrackedFrame& tracked) {
    if (!closed_) return;
    FrameReport& report = tracked.report;
    const double gap_s = frame.stamp_s - last_stamp_s_;
    if (std::exchange(first_, false) && gap_s > 0 && gap_s <= max_gap_s_) {
        closed_ = false;
        return;
    }
    if (IsThere(report.track)) {
        closed_ = false;
        report.warning = "the scan continues where it ended";
    } else if (report.tracked()) {
        tracking.RejectPose(
            "the camera is not where the scan ended: show it what it saw last; with colour and "
            "--loop-closure on a scan can continue at any place it has seen",
            tracked);
    }
}

}  // namespace tessera
