// After a loss: when is the camera believed to be where tracking has it? A pose that fits somewhere
// is not enough once the camera can be anywhere; it must have been found by its looks, or have come
// back where it was lost.
#pragma once

#include <cmath>
#include <utility>

#include "optimize/loop_config.h"
#include "system/tracking_stage.h"

namespace tessera {

// Owner thread only.
class LostCamera {
  public:
    enum class Verdict { kTracking, kFoundAgain, kLost };

    // `max_gap_s`: for so long after the last tracked frame the camera is thought to be near it.
    LostCamera(const LoopConfig& config, double max_gap_s)
        : config_(config), max_gap_s_(max_gap_s) {}

    // Of each frame after it was tracked, once. kLost: whatever its status says, it is not to be
    // believed.
    Verdict Judge(const TrackedFrame& tracked) {
        const FrameReport& report = tracked.report;
        started_ = started_ || report.first;
        if (std::exchange(resumed_, false))
            lost_ = std::abs(report.stamp_s - last_seen_s_) > max_gap_s_;
        lost_ = (lost_ || !report.tracked()) && started_ && !report.first;
        if (!lost_) {
            if (report.tracked()) last_seen_s_ = report.stamp_s;
            return Verdict::kTracking;
        }
        const bool lately = report.stamp_s - last_seen_s_ <= max_gap_s_;
        if (!FitsWell(report.track) || !(lately || !tracked.prepared.has_colour))
            return Verdict::kLost;
        Found(report.stamp_s);
        return Verdict::kFoundAgain;
    }

    // An earlier scan goes on: unless the next frame follows soon on this time, the camera counts
    // as lost.
    void Resume(double last_seen_s) {
        last_seen_s_ = last_seen_s;
        started_ = resumed_ = true;
    }

    // It was found otherwise, and tracked there.
    void Found(double stamp_s) {
        lost_ = false;
        last_seen_s_ = stamp_s;
    }
    // At this time it was somewhere that tracking knows; that it fits there is still to be seen.
    void Seen(double stamp_s) { last_seen_s_ = stamp_s; }

  private:
    bool FitsWell(const TrackResult& track) const {
        return track.status == TrackStatus::kGood && track.inlier_fraction >= config_.min_fit &&
               track.known_fraction >= config_.min_known_fraction;
    }

    LoopConfig config_;
    double max_gap_s_;
    double last_seen_s_ = 0;
    bool started_ = false, lost_ = false, resumed_ = false;
};

inline constexpr const char* kNotBelieved =
    "nothing confirms that the camera is where it seems to be after the loss";

}  // namespace tessera
