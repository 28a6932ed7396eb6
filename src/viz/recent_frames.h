// The last seconds of a run: how many frames were dropped, and how fast the camera moved. Owner
// thread only.
#pragma once

#include <deque>

#include "system/viewer_link.h"

namespace tessera {

class RecentFrames {
  public:
    static constexpr double kSpan_s = 2;      // of the counts
    static constexpr double kMotion_s = 0.4;  // of the speeds, by the frames' stamps

    // `now_s`: any steady clock.
    void Add(const FrameUpdate& update, double now_s);

    // In the last kSpan_s before the newest frame; since the start if the run is younger.
    RunCounts counts() const;
    // Of the camera; 0 while it is lost or just found.
    double speed_m_s() const { return speed_m_s_; }
    double turn_rad_s() const { return turn_rad_s_; }
    // Since the newest frame arrived; 0 before the first.
    double SilentFor_s(double now_s) const {
        return arrivals_.empty() ? 0 : now_s - arrivals_.back().at_s;
    }

  private:
    struct Arrival {
        double at_s = 0;
        RunCounts counts;
    };
    struct Place {
        double stamp_s = 0;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    };
    void Move(const FrameReport& report);

    std::deque<Arrival> arrivals_;
    RunCounts before_;  // the counts when the span began
    std::deque<Place> places_;
    double speed_m_s_ = 0, turn_rad_s_ = 0;
};

}  // namespace tessera
