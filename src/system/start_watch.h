// Notices a scan that has hardly begun when tracking was lost: the camera turned away too fast, or
// the first frames showed a hand. Little is lost by beginning again, and all of the rest is won.
#pragma once

#include "system/tracking_stage.h"

namespace tessera {

// The tracking stage's owner thread only.
class StartWatch {
  public:
    // Call after each frame, when its status is final.
    void Add(const TrackedFrame& tracked) {
        const FrameReport& report = tracked.report;
        if (report.track.status == TrackStatus::kGood) {
            ++good_;
            lost_ = 0;
            good_s_ = report.stamp_s;
        }
        if (!report.tracked() && tracked.prepared.valid_depth_pixels > 0) ++lost_;
        failed_ = good_ > 0 && good_ <= kFew && lost_ >= good_ && !report.tracked() &&
                  report.stamp_s - good_s_ >= kLong_s;
    }
    // Only a few frames were tracked well, and since then none: as many at least, for a second.
    bool failed() const { return failed_; }
    void Clear() { *this = {}; }

  private:
    static constexpr int kFew = 10;
    static constexpr double kLong_s = 1;

    std::int64_t good_ = 0, lost_ = 0;  // frames; of the lost ones those with depth
    double good_s_ = 0;                 // the last frame that was tracked well
    bool failed_ = false;
};

inline constexpr const char* kStartFailed =
    "tracking was lost right after the start: the map and the path start again";

}  // namespace tessera
