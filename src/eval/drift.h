// Drift of a trajectory: how the relative pose error grows with the distance travelled, as KITTI's
// odometry benchmark measures it (Geiger et al., CVPR 2012), and what is left of it where the
// camera returns to a place.
#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "core/se3.h"
#include "core/status.h"
#include "eval/statistics.h"

namespace tessera {

struct DriftResult {
    struct OverDistance {
        double distance_m = 0;
        std::size_t pairs = 0;
        double trans_fraction = 0;  // RMSE of the translation error, as a share of the distance
        double rot_rad_per_m = 0;   // RMSE of the rotation error over the distance
    };
    struct Revisit {
        double first_s = 0, again_s = 0;  // the estimate's stamps
        double trans_m = 0, rot_rad = 0;  // error of the relative pose of the two
    };
    double path_m = 0;                        // of the reference
    std::vector<OverDistance> over_distance;  // 1, 2, 5, 10, ... m, as far as the path goes
    std::vector<Revisit> revisits;            // in time order
    ErrorStatistics revisit_m, revisit_rad;   // of `revisits`; all zero if there are none
};

// Pairs are poses of the estimate with a reference pose within 0.02 s. A revisit is a pose, one
// every 10 cm, whose nearest earlier pose is at most 0.5 m and 0.5 rad away, 5 m or more of the
// path before. Error if fewer than two poses have a reference. Thread-safe.
Result<DriftResult> EvaluateDrift(const std::vector<StampedPose>& reference,
                                  const std::vector<StampedPose>& estimate);

// {"path_m", "over_distance": [{"distance_m", "pairs", "trans_percent", "rot_deg_per_m"}],
// "revisits": {"count", "trans_rmse_m", "trans_max_m", "rot_rmse_deg"}}
std::string DriftJson(const DriftResult& result);

// Both paths from above and from the side, aligned with the reference, whose z is up: `tracked` in
// grey and the corrected estimate in the colour of its distance from it; below, that distance over
// time. 1280 x 960 pixels. `title` must be ASCII. Error if the trajectories cannot be aligned.
// Thread-safe.
Result<ColourImage> PlotCorrection(const std::vector<StampedPose>& reference,
                                   const std::vector<StampedPose>& tracked,
                                   const std::vector<StampedPose>& estimate,
                                   const std::string& title);

}  // namespace tessera
