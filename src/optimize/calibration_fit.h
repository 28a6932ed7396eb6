// A calibration's fit, linearised at its solution, and how far it is to be believed.
#pragma once

#include <Eigen/Sparse>
#include <vector>

#include "optimize/calibration_model.h"

namespace tessera {

struct CalibrationFit {
    // Robust weights are in both. Rows: what is known before, then one for each pair. Columns: the
    // calibration's unknowns that were solved for, then poses.
    Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian;
    Eigen::VectorXd residuals;
    std::vector<PlanePair> pairs;
    int views = 0;
    int unknowns = 0;  // columns of the calibration
};

// A jackknife: how much each unknown changes where a part of the pairs is left out (one
// Gauss-Newton step from the solution), as the standard deviation that it means for the whole.
// `part`: of each pair, from 0 to parts - 1.
Eigen::VectorXd JackknifeSpread(const CalibrationFit& fit, const std::vector<int>& part, int parts);

// Standard deviation of each unknown: of the residuals' scatter, and of the jackknifes over times,
// distances, distances from the image's centre and the image's quarters, all added in squares. An
// error that the model does not have (lenses, a rolling shutter, a sensor's own distortion) is not
// the same in all of these parts, and so makes it large, where the scatter alone would call the
// result certain.
Eigen::VectorXd Deviations(const CalibrationFit& fit);

}  // namespace tessera
