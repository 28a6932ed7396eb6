// One camera for many pairs of views: Gauss-Newton over all motions and the camera's unknowns,
// coarse to fine, the motions eliminated pair by pair.
#pragma once

#include <span>
#include <vector>

#include "optimize/camera_pair.h"

namespace tessera {

struct CameraFit {
    using Vector = Eigen::Matrix<double, CameraUnknowns::kCount, 1>;

    CameraUnknowns unknowns;
    // Standard deviations by what differs between parts: eight times, rings and quarters of the
    // image, near and far, upright and level edges; squares added. An error that the model lacks (a
    // lens, a bent depth) is not the same in all of these.
    Vector deviations = Vector::Zero();
    // Robust error of a point with the camera as given and as found, motions free.
    double misfit_given = 0, misfit_found = 0;
    int pairs = 0;  // that were usable to the end; 0: no estimate
};

// `pairs` have motions to start from, and `views` are in order of time; their motions are left as
// they came out. The result does not depend on the number of threads.
CameraFit FitCamera(const std::vector<CameraView>& views, const PinholeCamera& given,
                    std::vector<CameraPair>& pairs);

}  // namespace tessera
