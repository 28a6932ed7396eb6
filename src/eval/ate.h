// Absolute trajectory error: how far the estimated positions lie from the reference after one rigid
// alignment of the whole path, as TUM's evaluate_ate.py (Sturm et al., IROS 2012).
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
    // How many frames the run was given, if known (FramesOfRun).
    std::optional<std::int64_t> frames;
};

struct AteResult {
    struct Pair {
        double stamp_s;               // the estimate's
        Eigen::Vector3d p_reference;  // metres, reference's world
        Eigen::Vector3d p_estimate;   // the same frame: after the alignment
        double error_m;               // between the two
    };
    ErrorStatistics error_m;
    // The estimate's poses over the frames of the run where their number is known; else the share
    // of the estimate's poses that have a reference.
    double tracked_fraction = 0;
    Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();
    std::vector<Pair> pairs;  // by time
    std::string warning;      // as Alignment's
};

// SE(3) alignment without scale over all pairs. Errors as AlignTrajectories. Thread-safe.
Result<AteResult> EvaluateAte(const std::vector<StampedPose>& reference,
                              const std::vector<StampedPose>& estimate,
                              const AteOptions& options = {});

// The number of frames that the run of this trajectory file was given: "frames" of the
// timings.json beside it; nothing where there is none, or none that can be read.
std::optional<std::int64_t> FramesOfRun(const std::string& trajectory_path);

// {"ate_rmse_m", "ate_mean_m", "ate_median_m", "ate_max_m", "pairs", "tracked_fraction",
// "alignment": "se3"}
std::string AteJson(const AteResult& result);

}  // namespace tessera
