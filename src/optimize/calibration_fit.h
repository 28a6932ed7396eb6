// A calibration fit linearised at its solution, and the uncertainty of its result.
#pragma once

#include <Eigen/Sparse>
#include <vector>

#include "optimize/calibration_model.h"

namespace tessera {

struct CalibrationFit {
    // Both include the robust weights. Rows: the priors, then one per pair. Columns: the
    // calibration unknowns that were solved for, then the poses.
    Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian;
    Eigen::VectorXd residuals;
    std::vector<PlanePair> pairs;
    int views = 0;
    int unknowns = 0;  // number of calibration columns
};

// Jackknife: leaves out each part of the pairs, takes one Gauss-Newton step from the solution, and
// returns the standard deviation of the full result that these changes imply. `part`: the part of
// each pair, from 0 to parts - 1.
Eigen::VectorXd JackknifeSpread(const CalibrationFit& fit, const std::vector<int>& part, int parts);

// Standard deviation of each unknown. Adds the variance from the scatter of the residuals and from
// jackknifes over time, distance, distance from the image centre and image quadrant. An error that
// the model lacks (lens distortion, rolling shutter, sensor distortion) differs between these parts
// and so raises the result, whereas the scatter alone would make it look certain.
Eigen::VectorXd Deviations(const CalibrationFit& fit);

}  // namespace tessera
