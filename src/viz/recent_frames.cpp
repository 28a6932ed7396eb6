#include "viz/recent_frames.h"

#include "core/se3.h"

namespace tessera {

void RecentFrames::Add(const FrameUpdate& update, double now_s) {
    if (update.report.first) places_.clear();
    if (update.report.first && !update.report.begins_part) {
        arrivals_.clear();
        before_ = {};
    }
    arrivals_.push_back({now_s, update.counts});
    while (now_s - arrivals_.front().at_s > kSpan_s) {
        before_ = arrivals_.front().counts;
        arrivals_.pop_front();
    }
    Move(update.report);
}

RunCounts RecentFrames::counts() const {
    if (arrivals_.empty()) return {};
    RunCounts n = arrivals_.back().counts;
    n.frames -= before_.frames;
    n.tracked -= before_.tracked;
    n.fused -= before_.fused;
    n.poor -= before_.poor;
    n.lost -= before_.lost;
    n.skipped -= before_.skipped;
    n.dropped -= before_.dropped;
    n.unfused -= before_.unfused;
    n.degenerate -= before_.degenerate;
    return n;
}

void RecentFrames::Move(const FrameReport& report) {
    speed_m_s_ = turn_rad_s_ = 0;
    if (!report.tracked()) return places_.clear();
    if (!places_.empty() && report.stamp_s <= places_.back().stamp_s) places_.clear();
    places_.push_back({report.stamp_s, report.track.T_world_camera});
    while (report.stamp_s - places_.front().stamp_s > kMotion_s) places_.pop_front();
    const double span_s = report.stamp_s - places_.front().stamp_s;
    if (span_s <= 0) return;
    double way_m = 0, angle_rad = 0;
    for (std::size_t i = 1; i < places_.size(); ++i) {
        const Eigen::Isometry3d &from = places_[i - 1].T_world_camera,
                                &to = places_[i].T_world_camera;
        way_m += (to.translation() - from.translation()).norm();
        angle_rad += RotationAngle(from, to);
    }
    speed_m_s_ = way_m / span_s;
    turn_rad_s_ = angle_rad / span_s;
}

}  // namespace tessera
