// Notices that tracking has been lost for so long that the camera may be anywhere: then a new part
// of the scan begins (optimize/scan_parts.h).
#pragma once

#include <cmath>
#include <optional>

#include "optimize/scan_parts.h"
#include "system/lost_camera.h"
#include "system/tracking_stage.h"

namespace tessera {

// The tracking stage's owner thread only.
class LossWatch {
  public:
    // Call after each frame, when its status is final. The clock may start again.
    void Add(const TrackedFrame& tracked) {
        const FrameReport& report = tracked.report;
        if (report.track.status == TrackStatus::kGood) {
            ++good_;
            lost_ = 0;
            good_s_ = report.stamp_s;
        }
        if (report.tracked()) {
            tracked_s_ = report.stamp_s;
            lost_since_s_.reset();
        }
        anywhere_ = false;
        if (good_ == 0 || report.tracked() || tracked.prepared.valid_depth_pixels == 0 ||
            !tracked.prepared.has_colour)
            return;
        ++lost_;
        if (!lost_since_s_) lost_since_s_ = report.stamp_s;
        anywhere_ = good_ <= kShortPart
                        ? lost_ >= good_ && std::abs(report.stamp_s - good_s_) >= kLooking_s
                        : std::abs(report.stamp_s - *lost_since_s_) >= kLooking_s &&
                              std::abs(report.stamp_s - tracked_s_) >= kWithinReach_s;
    }
    // The camera sees something, and has been looked for long enough.
    bool anywhere() const { return anywhere_; }
    void Clear() { *this = {}; }

  private:
    static constexpr double kLooking_s = 1;

    std::int64_t good_ = 0, lost_ = 0;    // frames; lost ones since the last good one
    double good_s_ = 0, tracked_s_ = 0;   // the last frame that was tracked well, or at all
    std::optional<double> lost_since_s_;  // the first frame since then that saw something
    bool anywhere_ = false;
};

inline constexpr const char* kPartBegins =
    "the camera is found nowhere; a new part of the scan begins, to be joined with the rest when a "
    "place is seen again";

}  // namespace tessera
