// Relative pose error: how much the motion over a fixed time differs from the reference's, as in
// TUM's evaluate_rpe.py --fixed_delta (Sturm et al., IROS 2012). Measures drift; needs no
// alignment.
#pragma once

#include <string>
#include <vector>

#include "core/se3.h"
#include "core/status.h"
#include "eval/statistics.h"

namespace tessera {

struct RpeOptions {
    double delta_s = 1.0;  // time over which motions are compared
};

struct RpeResult {
    struct Pair {
        double begin_s, end_s;  // the estimate's stamps
        double trans_m;
        double rot_rad;
    };
    ErrorStatistics trans_m;
    ErrorStatistics rot_rad;
    double delta_s = 1.0;
    std::vector<Pair> pairs;
};

// Pairs every pose of the estimate with the estimated pose nearest to delta_s later, and each of
// the two with the nearest reference pose, at most two median reference intervals away. Uses all
// pairs (the script draws 10,000 at random), with two exceptions. Pairs that end at the last pose
// are dropped, as in the script. Pairs whose duration differs from delta_s by more than a tenth (a
// gap in the estimate) are dropped, too; the script keeps them. If there are no pairs, that is an
// error. Thread-safe.
Result<RpeResult> EvaluateRpe(const std::vector<StampedPose>& reference,
                              const std::vector<StampedPose>& estimate,
                              const RpeOptions& options = {});

// {"rpe_trans_rmse_m", "rpe_trans_median_m", "rpe_trans_max_m", "rpe_rot_rmse_deg",
// "rpe_rot_median_deg", "rpe_rot_max_deg", "pairs", "delta_s"}
std::string RpeJson(const RpeResult& result);

}  // namespace tessera
