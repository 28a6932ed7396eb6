#include "system/resume_gate.h"

namespace tessera {

void ResumeGate::Begin(std::span<const std::uint8_t> saved, const std::optional<StampedPose>& last, bool gated,
                       TrackingStage& tracking) {
    if (!last) return;
    StateReader state(saved);
    if (!tracking.LoadState(state) || !state.at_end()) tracking.StartAt(*last);
    last_stamp_s_ = last->stamp_s;
    closed_ = first_ = gated;
}

void ResumeGate::AfterTracking(const Frame& frame, TrackingStage& tracking, TrackedFrame& tracked) {
    if (!closed_) return;
    FrameReport& report = tracked.report;
    const double gap_s = frame.stamp_s - last_stamp_s_;
    if (std::exchange(first_, false) && gap_s > 0 && gap_s <= max_gap_s_) {
        closed_ = false;
        return;
    }
    const TrackResult& track = report.track;
    if (track.status == TrackStatus::kGood && track.inlier_fraction >= config_.min_fit &&
        track.known_fraction >= config_.min_known_fraction) {
        closed_ = false;
        report.warning = "the scan goes on where it ended";
    } else if (report.tracked()) {
        tracking.Disbelieve("the camera is not where the scan ended: show it what it saw there last; a scan with --loop-closure on "
                            "goes on anywhere", tracked);
    }
}

}  // namespace tessera
