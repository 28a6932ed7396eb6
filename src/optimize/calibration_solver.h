// Solves jointly for the calibration and the keyframe poses.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/status.h"
#include "optimize/calibration_fit.h"
#include "optimize/calibration_pairs.h"

namespace tessera {

struct CalibrationProblem {
    PinholeCamera camera;  // of the full images, as given
    const std::vector<CalibrationView>& views;
    std::span<const PoseEdge> edges;  // the views to compare, and what is known about their poses
};

// Which unknowns are solved for; the others stay at 0.
using CalibrationMask = std::array<bool, CalibrationUnknowns::kCount>;

struct CalibrationEstimate {
    CalibrationUnknowns unknowns;
    // Standard deviations; 0 for unknowns that were not solved for.
    std::array<double, CalibrationUnknowns::kCount> sigma{};
    std::vector<Eigen::Isometry3d> T_world_camera;
    double rms_before_m = 0, rms_m = 0;  // robust distances of points from surfaces of other views
    int points = 0;
};

// Errors: too little overlap, or no usable solution. Runs on one thread; deterministic.
Result<CalibrationEstimate> SolveCalibration(const CalibrationProblem& problem,
                                             const std::vector<Eigen::Isometry3d>& T_world_camera,
                                             const CalibrationMask& mask);

}  // namespace tessera
