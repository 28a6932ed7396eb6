// When the frames of a recording are due, at its pace or a multiple of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera {

// Owner thread only.
class PlaybackClock {
  public:
    explicit PlaybackClock(double speed) : speed_(speed) {}

    // Seconds to wait, now that the next frame is there, until it is as long after the first frame
    // as it was recorded. A pause in the recording is not waited for: a gap of more than a second,
    // unless the frames come so slowly. Nor is time made up for if the reader is a second late.
    double Wait_s(double stamp_s, double now_s) {
        constexpr double kPause_s = 1, kMuchLonger = 2, kLate_s = 1;
        const double gap_s = stamp_s - last_stamp_s_,
                     pause_s = std::max(kPause_s, kMuchLonger * gap_s_);
        if (!std::isnan(gap_s)) gap_s_ = gap_s;
        last_stamp_s_ = stamp_s;
        if (gap_s >= 0 && gap_s <= pause_s) {
            const double wait_s = (stamp_s - first_.stamp_s) / speed_ - (now_s - first_.passed_s);
            if (wait_s > -kLate_s) return std::max(wait_s, 0.0);
        }
        first_ = {stamp_s, now_s};
        return 0;
    }
    // The next frame is due at once.
    void Restart() { last_stamp_s_ = kNone; }

  private:
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    struct First {
        double stamp_s = 0, passed_s = 0;
    };
    const double speed_;
    First first_;
    double last_stamp_s_ = kNone;
    double gap_s_ = 0;  // between the last two frames
};

}  // namespace tessera
