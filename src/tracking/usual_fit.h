// How well frames usually fit the map. Where the prediction of the pose is worth nothing (after a
// gap in time, after frames that fitted badly), a frame must fit as well: at a wrong pose half of a
// view may fit, walls to walls and floor to floor, but hardly more; and where hardly any of the
// view is known, all of it may. Owner thread only.
#pragma once

#include <string>

#include "tracking/tracker.h"

namespace tessera {

class UsualFit {
  public:
    // `misfit`: how much below the usual inlier fraction a frame may be, as a share of it; 1:
    // nothing is demanded. A frame may have fewer inliers if its distances are as small as usual:
    // what has changed in the scene is then an outlier and the rest fits. `least_known`: known
    // fraction.
    UsualFit(double misfit, double least_known) : misfit_(misfit), least_known_(least_known) {}

    // A frame that can be trusted.
    void Add(const TrackResult& track);
    // Whether a frame fits as well. True while nothing is known.
    bool Matches(const TrackResult& track) const;
    // Why it does not.
    std::string Reason(const TrackResult& track) const;
    void Clear() { inliers_ = distance_rms_m_ = 0; }

  private:
    double misfit_, least_known_;
    double inliers_ = 0;  // usual inlier fraction; 0: not known
    double distance_rms_m_ = 0;
};

}  // namespace tessera
