// Decides after a loss when to trust the tracked pose again. A good fit alone is not enough if the
// camera can be anywhere: it must be relocalised by appearance, or be tracked again soon after the
// loss, or where it can have got to meanwhile.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "optimize/loop_config.h"
#include "system/tracking_stage.h"

namespace tessera {

// A view of a known place is almost completely known, and it fits. Elsewhere a tracker that starts
// from a wrong pose may converge to one that fits only in part. (fr1 rpy: median 7 mm, 94 %
// inliers; a wrong place in the box room: 21 mm, 89 %.)
inline bool FitsCompletely(const TrackResult& track) {
    constexpr double kKnown = 0.8, kFits = 0.85, kDistance_m = 0.012;
    return track.status != TrackStatus::kLost && track.known_fraction >= kKnown &&
           track.inlier_fraction >= kFits && track.distance_rms_m <= kDistance_m;
}

// For this long after the camera was tracked last it is within reach of that place. Later it may be
// anywhere, and must be found by appearance.
inline constexpr double kWithinReach_s = 2;

// Owner thread only.
class LostCamera {
  public:
    // kDoubtful: tracked, but the pose may be wrong: it was poor for long, or the scene left a
    // motion open and the camera may have drifted along it. Look for the camera.
    enum class Verdict { kTracking, kFoundAgain, kDoubtful, kLost };

    // `max_gap_s`: for this long after the last tracked frame, the camera is assumed to be near its
    // last pose.
    LostCamera(const LoopConfig& config, double max_gap_s)
        : config_(config), max_gap_s_(max_gap_s) {}

    // Call once for each frame, after tracking. kLost: do not trust the pose, whatever its status.
    Verdict Judge(const TrackedFrame& tracked) {
        const FrameReport& report = tracked.report;
        started_ = started_ || report.first;
        coloured_ = coloured_ || tracked.prepared.has_colour;
        if (std::exchange(resumed_, false))
            lost_ = lost_ || std::abs(report.stamp_s - last_seen_s_) > max_gap_s_;
        if (report.first) BackOnTrack(report.stamp_s);
        lost_ = (lost_ || !report.tracked()) && started_ && !report.first;
        if (!lost_) return report.tracked() ? JudgeTracked(report) : Verdict::kTracking;
        poor_since_s_.reset();
        // If it has been lost for long, a fit alone is not enough: another place may fit, too.
        const bool lately = std::abs(report.stamp_s - last_seen_s_) <= max_gap_s_;
        const bool reached = CanReach({report.stamp_s, report.track.T_world_camera});
        // A camera that shows no colours is never found by appearance.
        const bool fits = FitsWell(report.track) && (lately || reached || !coloured_);
        const bool there = FitsCompletely(report.track) && reached;
        if (!fits && !there) return Verdict::kLost;
        // What the view leaves open is as it was when the camera was relocalised.
        if (relocalised_ && report.track.degenerate) return Verdict::kLost;
        BackOnTrack(report.stamp_s);
        return Verdict::kFoundAgain;
    }

    // An earlier scan is resumed, in which the camera was tracked last at this time. It counts as
    // lost unless the next frame follows soon after that. `lost`: it was when the scan ended.
    void Resume(double last_seen_s, bool lost = false) {
        last_seen_s_ = last_seen_s;
        lost_ = lost;
        started_ = resumed_ = true;
    }

    // The camera was relocalised and tracked there.
    void BackOnTrack(double stamp_s) {
        Confirm();
        lost_ = relocalised_ = false;
        last_seen_s_ = stamp_s;
    }
    // Whether the camera can have got there from where it was tracked last: there is then no other
    // place to mistake this one for.
    bool CanReach(const StampedPose& found) const {
        // Near: what a frame may be off the prediction and still be trusted, at both ends.
        constexpr double kFastest_m_per_s = 1, kNear_m = 0.4;
        const double gap_s = before_ ? std::abs(found.stamp_s - before_->stamp_s) : 0;
        if (!before_ || gap_s > kWithinReach_s) return false;
        const double way_m =
            (found.T_world_camera.translation() - before_->T_world_camera.translation()).norm();
        return way_m <= kNear_m + kFastest_m_per_s * gap_s;
    }
    // It has got there: that is where it was last.
    void SetLastGood(const StampedPose& found) { before_ = found; }
    // The map was moved.
    void Move(const Eigen::Isometry3d& T_new_old) {
        if (before_) before_->T_world_camera = Normalised(T_new_old * before_->T_world_camera);
    }
    // It was tracked poorly, and was seen at another place: that place is to be confirmed.
    void Doubt() { lost_ = true; }
    // Where it was doubted, it was seen at the same place.
    void Confirm() {
        drift_m2_ = 0;
        drifted_since_s_.reset();
    }
    // The place where the camera was found was wrong.
    void Lose() {
        lost_ = true;
        before_.reset();
        last_seen_s_ = std::numeric_limits<double>::lowest();
    }
    // The camera was relocalised at this time. Tracking must still confirm the pose.
    void SetRelocalised(double stamp_s) {
        last_seen_s_ = stamp_s;
        relocalised_ = true;
    }

    bool lost() const { return lost_; }
    // By appearance, and not confirmed by tracking yet.
    bool relocalised() const { return relocalised_; }

  private:
    Verdict JudgeTracked(const FrameReport& report) {
        last_seen_s_ = report.stamp_s;
        if (report.track.status == TrackStatus::kGood) {
            before_ = {report.stamp_s, report.track.T_world_camera};
            poor_since_s_.reset();
        } else if (!poor_since_s_) {
            poor_since_s_ = report.stamp_s;
        }
        const bool long_poor =
            std::abs(report.stamp_s - poor_since_s_.value_or(report.stamp_s)) > max_gap_s_;
        return long_poor || Drifted(report) ? Verdict::kDoubtful : Verdict::kTracking;
    }
    // Before a bare wall the camera drifts unseen along it. True for a while from the first frame
    // on that shows enough again.
    bool Drifted(const FrameReport& report) {
        // What a frame adds is at most the error of the predicted pose, which it follows then.
        constexpr double kPredicted_m = 0.02, kDrift_m = 0.05;
        const double error_m = std::min(report.track.uncertainty_m, kPredicted_m);
        if (report.track.degenerate) {
            drift_m2_ += error_m * error_m;
            return false;
        }
        if (drift_m2_ > kDrift_m * kDrift_m) {
            if (!drifted_since_s_) drifted_since_s_ = report.stamp_s;
            if (std::abs(report.stamp_s - *drifted_since_s_) <= max_gap_s_) return true;
        }
        Confirm();
        return false;
    }
    bool FitsWell(const TrackResult& track) const {
        return track.status == TrackStatus::kGood && track.inlier_fraction >= config_.min_fit &&
               track.known_fraction >= config_.min_known_fraction;
    }

    LoopConfig config_;
    double max_gap_s_;
    double last_seen_s_ = 0;
    std::optional<StampedPose> before_;  // the last pose that was tracked well, or found
    std::optional<double> poor_since_s_;
    double drift_m2_ = 0;  // variance, since the pose was last known in all motions
    std::optional<double> drifted_since_s_;
    bool started_ = false, lost_ = false, resumed_ = false;
    bool relocalised_ = false;
    bool coloured_ = false;  // some frame had colour
};

inline constexpr const char* kPoseUnconfirmed =
    "nothing confirms the pose found after tracking was lost";

}  // namespace tessera
