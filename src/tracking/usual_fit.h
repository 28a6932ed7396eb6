// How well frames usually fit the map. Where the prediction of the pose is worth nothing (after a
// gap in time, after frames that fitted badly, far from it), a frame must fit as well: at a wrong
// pose half of a view may fit, walls to walls and floor to floor, but hardly more; and where hardly
// any of the view is known, all of it may. Owner thread only.
#pragma once

#include <optional>
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
    // Whether a frame fits as well. Before the first, 95 % are usual.
    bool Matches(const TrackResult& track) const;
    // Whether a frame shows nothing that is new to the map and fits as well: at a wrong pose far
    // from the right one, a part of the view would lie outside. False if nothing is demanded.
    bool Confirms(const TrackResult& track) const;
    // Whether a frame so long after the last one follows it closely enough for the motion model to
    // predict its pose, as far as it usually does.
    bool Predicted(double since_last_s) const;
    // Why it does not match.
    std::string Reason(const TrackResult& track) const;
    void Clear() { *this = UsualFit(misfit_, least_known_); }
    // Of the frames so far, few may have been found far from their predictions because the others
    // were lost.
    void ForgetPredictions() { innovation_share_.reset(); }

  private:
    double misfit_, least_known_;
    bool known_ = false;  // a frame was added: these are means over the last ten
    // Before, in a map of a single frame, right poses have had 89 to 99 % of inliers.
    double inliers_ = 0.95, distance_rms_m_ = 0;
    std::optional<double> innovation_share_;
};

}  // namespace tessera
