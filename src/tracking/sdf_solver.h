// From the sums over all points to a step: the Gauss-Newton solution of [B14] eq. 11 with the frame's brightness
// eliminated, and what the Hessian says about how well the scene holds the camera.
#pragma once

#include "core/se3.h"
#include "tracking/sdf_kernels.h"

namespace tessera {

struct SdfSums {
    double value[SdfSumLayout::kCount] = {};

    SdfSums& operator+=(const SdfSums& other);
    double operator[](int i) const { return value[i]; }
};

struct SdfStep {
    bool valid = false;         // false where the system is singular or not finite
    Vector6d increment;         // left increment about the local origin
    double gain_change = 0, offset_change = 0;
    double smallest_eigenvalue = 0;  // of the normalised Hessian, see NormalisedHessian
    int held_directions = 0;    // eigenvectors along which the step was set to zero
};

struct SdfSolverOptions {
    bool estimate_brightness = true;
    double brightness_prior = 0.05;   // weight of "gain 1, offset 0" per unit of photometric weight
    double min_eigenvalue = 0;       // directions below are held, not moved
};

// `gain` and `offset` are the present values, which the prior pulls at.
SdfStep SolveSdfStep(const SdfSums& sums, const SdfSolverOptions& options, double gain, double offset,
                     const Eigen::Vector3d& camera_local, double scene_depth_m);

// The pose's Hessian made comparable between scenes: increments about the camera, rotations scaled by the scene's
// depth so that both halves are metres, divided by its trace. Its eigenvalues sum to 1.
Matrix6d NormalisedHessian(const Matrix6d& hessian_local, const Eigen::Vector3d& camera_local, double scene_depth_m);

}  // namespace tessera
