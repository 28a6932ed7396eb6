// Fits one camera to many pairs of views. Gauss-Newton over all motions and the camera unknowns,
// coarse to fine; the motions are eliminated pair by pair.
#pragma once

#include <span>
#include <vector>

#include "optimize/camera_pair.h"

namespace tessera {

struct CameraFit {
    using Vector = Eigen::Matrix<double, CameraUnknowns::kCount, 1>;

    CameraUnknowns unknowns;
    // Standard deviations from differences between parts: eight time spans, rings and quadrants of
    // the image, near and far, vertical and horizontal edges; variances added. An error that the
    // model lacks (lens distortion, a distorted depth image) differs between these parts.
    Vector deviations = Vector::Zero();
    // Robust error per point with the given and with the estimated camera; motions are free in
    // both.
    double misfit_given = 0, misfit_found = 0;
    int pairs = 0;  // usable to the end; 0: no estimate
};

// `pairs` must have initial motions; returns the refined ones in them. `views` must be in time
// order. The result does not depend on the number of threads.
CameraFit FitCamera(const std::vector<CameraView>& views, const PinholeCamera& given,
                    std::vector<CameraPair>& pairs);

}  // namespace tessera
