#include "tracking/usual_fit.h"

#include <fmt/format.h>

namespace tessera {

void UsualFit::Add(const TrackResult& track) {
    const double share = known_ ? 0.1 : 1.0;
    known_ = true;
    inliers_ += share * (track.inlier_fraction - inliers_);
    distance_rms_m_ += share * (track.distance_rms_m - distance_rms_m_);
    // A frame that leaves a motion open may be far from its prediction because its pose is wrong:
    // it is no first evidence against predictions.
    if (track.degenerate && !innovation_share_) return;
    const double before = innovation_share_.value_or(track.innovation_share);
    innovation_share_ = before + share * (track.innovation_share - before);
}

bool UsualFit::Matches(const TrackResult& track) const {
    if (misfit_ >= 1) return true;
    constexpr double kMostTimes = 1.25;
    return track.known_fraction >= least_known_ &&
           (track.inlier_fraction >= (1 - misfit_) * inliers_ ||
            track.distance_rms_m <= kMostTimes * distance_rms_m_);
}

bool UsualFit::Confirms(const TrackResult& track) const {
    return misfit_ < 1 && track.known_fraction * track.inlier_fraction >= (1 - misfit_) * inliers_;
}

bool UsualFit::Predicted(double since_last_s) const {
    // Twice its usual distance from the predictions must still be a good one. At first, that is
    // what a camera in a hand moves: some 0.2 m and 0.35 rad in a second.
    constexpr double kMostShare = 0.5, kShare_per_s = 2;
    return innovation_share_.value_or(kShare_per_s * since_last_s) < kMostShare;
}

std::string UsualFit::Reason(const TrackResult& track) const {
    if (track.known_fraction < least_known_)
        return fmt::format("only {:.0f} % of the depth lies in the map",
                           100 * track.known_fraction);
    return fmt::format("only {:.0f} % of the depth fits the map, usually {:.0f} %",
                       100 * track.inlier_fraction, 100 * inliers_);
}

}  // namespace tessera
