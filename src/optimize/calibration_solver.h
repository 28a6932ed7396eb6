// Calibration and poses of keyframes, solved for together.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/status.h"
#include "optimize/calibration_fit.h"
#include "optimize/calibration_pairs.h"

namespace tessera {

struct CalibrationProblem {
    PinholeCamera camera;  // of whole images, as given
    const std::vector<CalibrationView>& views;
    std::span<const PoseEdge> edges;  // which views are compared, and what is known of their poses
};

// Which unknowns are solved for; the others stay 0.
using CalibrationMask = std::array<bool, CalibrationUnknowns::kCount>;

struct CalibrationEstimate {
    CalibrationUnknowns unknowns;
    // Deviations; 0 where it was not solved for.
    std::array<double, CalibrationUnknowns::kCount> sigma{};
    std::vector<Eigen::Isometry3d> T_world_camera;
    double rms_before_m = 0, rms_m = 0;  // points off the surfaces of other views, robust
    int points = 0;
};

// Errors: too little is seen twice, or no usable solution. One thread: the same result on every
// run.
Result<CalibrationEstimate> SolveCalibration(const CalibrationProblem& problem,
                                             const std::vector<Eigen::Isometry3d>& T_world_camera,
                                             const CalibrationMask& mask);

}  // namespace tessera
