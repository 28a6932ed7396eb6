#include "tracking/usual_fit.h"

#include <fmt/format.h>

namespace tessera {

void UsualFit::Add(const TrackResult& track) {
    const double share = inliers_ > 0 ? 0.1 : 1.0;
    inliers_ += share * (track.inlier_fraction - inliers_);
    distance_rms_m_ += share * (track.distance_rms_m - distance_rms_m_);
}

bool UsualFit::Matches(const TrackResult& track) const {
    if (inliers_ <= 0 || misfit_ >= 1) return true;
    constexpr double kMostTimes = 1.25;
    return track.known_fraction >= least_known_ &&
           (track.inlier_fraction >= (1 - misfit_) * inliers_ ||
            track.distance_rms_m <= kMostTimes * distance_rms_m_);
}

std::string UsualFit::Reason(const TrackResult& track) const {
    if (track.known_fraction < least_known_)
        return fmt::format("only {:.0f} % of the depth lies in the map",
                           100 * track.known_fraction);
    return fmt::format("only {:.0f} % of the depth fits the map, usually {:.0f} %",
                       100 * track.inlier_fraction, 100 * inliers_);
}

}  // namespace tessera
