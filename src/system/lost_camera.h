// Decides after a loss when to trust the tracked pose again. A good fit alone is not enough if the
// camera can be anywhere: it must be relocalised by appearance, or be tracked again soon after the
// loss.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "optimize/loop_config.h"
#include "system/tracking_stage.h"

namespace tessera {

// Owner thread only.
class LostCamera {
  public:
    enum class Verdict { kTracking, kFoundAgain, kLost };

    // `max_gap_s`: for this long after the last tracked frame, the camera is assumed to be near its
    // last pose.
    LostCamera(const LoopConfig& config, double max_gap_s)
        : config_(config), max_gap_s_(max_gap_s) {}

    // Call once for each frame, after tracking. kLost: do not trust the pose, whatever its status.
    Verdict Judge(const TrackedFrame& tracked) {
        const FrameReport& report = tracked.report;
        started_ = started_ || report.first;
        if (std::exchange(resumed_, false))
            lost_ = std::abs(report.stamp_s - last_seen_s_) > max_gap_s_;
        lost_ = (lost_ || !report.tracked()) && started_ && !report.first;
        if (!lost_) {
            if (report.tracked()) {
                last_seen_s_ = report.stamp_s;
                before_ = {report.stamp_s, report.track.T_world_camera};
            }
            return Verdict::kTracking;
        }
        const bool lately = std::abs(report.stamp_s - last_seen_s_) <= max_gap_s_;
        if (!FitsWell(report.track) || !(lately || !tracked.prepared.has_colour))
            return Verdict::kLost;
        // What the view leaves open is as it was when the camera was relocalised.
        if (relocalised_ && report.track.degenerate) return Verdict::kLost;
        Found(report.stamp_s);
        return Verdict::kFoundAgain;
    }

    // An earlier scan is resumed. The camera counts as lost unless the next frame follows soon
    // after this time.
    void Resume(double last_seen_s) {
        last_seen_s_ = last_seen_s;
        started_ = resumed_ = true;
    }

    // The camera was relocalised and tracked there.
    void Found(double stamp_s) {
        lost_ = relocalised_ = false;
        last_seen_s_ = stamp_s;
    }
    // Whether the camera can have got there from where it was tracked last: there is then no other
    // place to mistake this one for.
    bool CanReach(const StampedPose& found) const {
        constexpr double kLongest_s = 2, kFastest_m_per_s = 1, kNear_m = 0.2;
        const double gap_s = before_ ? std::abs(found.stamp_s - before_->stamp_s) : 0;
        if (!before_ || gap_s > kLongest_s) return false;
        const double way_m =
            (found.T_world_camera.translation() - before_->T_world_camera.translation()).norm();
        return way_m <= kNear_m + kFastest_m_per_s * gap_s;
    }
    // The map was moved.
    void Move(const Eigen::Isometry3d& T_new_old) {
        if (before_) before_->T_world_camera = Normalised(T_new_old * before_->T_world_camera);
    }
    // The place where the camera was found was wrong.
    void Lose() {
        lost_ = true;
        before_.reset();
        last_seen_s_ = std::numeric_limits<double>::lowest();
    }
    // The camera was relocalised at this time. Tracking must still confirm the pose.
    void Seen(double stamp_s) {
        last_seen_s_ = stamp_s;
        relocalised_ = true;
    }

    bool lost() const { return lost_; }
    // By appearance, and not confirmed by tracking yet.
    bool relocalised() const { return relocalised_; }

  private:
    bool FitsWell(const TrackResult& track) const {
        return track.status == TrackStatus::kGood && track.inlier_fraction >= config_.min_fit &&
               track.known_fraction >= config_.min_known_fraction;
    }

    LoopConfig config_;
    double max_gap_s_;
    double last_seen_s_ = 0;
    std::optional<StampedPose> before_;  // the last pose that was tracked and not doubted
    bool started_ = false, lost_ = false, resumed_ = false;
    bool relocalised_ = false;
};

inline constexpr const char *kPoseUnconfirmed =
                                "nothing confirms the pose found after tracking was lost",
                            *kPlaceUnconfirmed =
                                "nothing is fused until a second view confirms the place",
                            *kPlaceConfirmed = "a second view confirms the place",
                            *kPlaceRefuted = "other views show that this is another place";

}  // namespace tessera
