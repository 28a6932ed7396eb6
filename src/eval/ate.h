// Absolute trajectory error: the distance of the estimated positions from the reference after one
// rigid alignment of the whole path, as in TUM's evaluate_ate.py (Sturm et al., IROS 2012).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/se3.h"
#include "core/status.h"
#include "eval/statistics.h"

namespace tessera {

struct AteOptions {
    double max_difference_s = 0.02;  // between the stamps of a pair
    // Number of frames in the run, if known (FramesOfRun).
    std::optional<std::int64_t> frames;
};

struct AteResult {
    struct Pair {
        double stamp_s;               // the estimate's
        Eigen::Vector3d p_reference;  // in the reference's world
        Eigen::Vector3d p_estimate;   // in the same frame, after alignment
        double error_m;               // distance between the two
    };
    ErrorStatistics error_m;
    // Number of estimated poses divided by the number of frames in the run, if that is known.
    // Otherwise the share of estimated poses that have a reference.
    double tracked_fraction = 0;
    bool of_frames = false;  // which of the two it is
    Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();
    std::vector<Pair> pairs;  // in time order
    std::string warning;      // see Alignment
};

// SE(3) alignment without scale over all pairs. Same errors as AlignTrajectories. Thread-safe.
Result<AteResult> EvaluateAte(const std::vector<StampedPose>& reference,
                              const std::vector<StampedPose>& estimate,
                              const AteOptions& options = {});

// The number of frames in the run that wrote this trajectory: "frames" in timings.json next to it.
// nullopt if that file is missing or invalid.
std::optional<std::int64_t> FramesOfRun(const std::string& trajectory_path);

// {"ate_rmse_m", "ate_mean_m", "ate_median_m", "ate_max_m", "pairs", "tracked_fraction",
// "alignment": "se3"}
std::string AteJson(const AteResult& result);

}  // namespace tessera
