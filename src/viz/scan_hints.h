// Advice for whoever holds the camera: where to point it and when to slow down. Pure functions,
// thread-safe; HintHolder: owner thread only.
#pragma once

#include <optional>
#include <string>

#include "core/image.h"
#include "tracking/tracker.h"

namespace tessera {

// What a depth image shows, as shares of its pixels.
struct DepthShares {
    double valid = 1;     // measured, up to the largest depth in use
    double too_far = 0;   // measured beyond it
    double median_m = 0;  // of the measured ones; 0: none
};
DepthShares SharesOf(const DepthImage& depth_m, double max_depth_m);

struct ScanSigns {
    TrackStatus status = TrackStatus::kGood;
    bool degenerate = false;
    double speed_m_s = 0, turn_rad_s = 0;  // of the camera
    double focal_px = 525;
    int width_px = 640;
    DepthShares depth;
    double max_depth_m = 5;
    double thin_share = 0;    // of the surface: measured too little (coverage.h)
    std::int64_t frames = 0;  // so far
};

// Length of the blur in the colour image, pixels, for an exposure of a sixtieth of a second.
double Blur_px(const ScanSigns& signs);

struct ScanHint {
    int urgency = 0;  // the greater, the more urgent
    std::string text;
};
// The most urgent advice; none if all is well.
std::optional<ScanHint> HintFor(const ScanSigns& signs);

// Keeps a hint on screen long enough to be read, unless a more urgent one comes.
class HintHolder {
  public:
    static constexpr double kShown_s = 1.5;

    // Returns what to show now; empty: nothing. `now_s`: any steady clock.
    const std::string& Update(const std::optional<ScanHint>& hint, double now_s);

  private:
    ScanHint shown_;
    double since_s_ = 0;
};

}  // namespace tessera
