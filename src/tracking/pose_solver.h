// From the sums over all points to a step: the Gauss-Newton solution of [B14] eq. 11 with the frame's brightness
// eliminated, and what the Hessian says about how well the scene holds the camera.
#pragma once

#include <functional>

#include "core/se3.h"
#include "tracking/normal_equations.h"

namespace tessera {

struct PoseSums {
    double value[SumLayout::kCount] = {};

    PoseSums& operator+=(const PoseSums& other);
    double operator[](int i) const { return value[i]; }
};

// Calls add(first, last, sums) for runs of at most kRunItems points (core/tile_sums.h), on all threads, and adds up what they
// leave in their order: the same bytes for any number of threads.
PoseSums SumPoints(int count, const std::function<void(int first, int last, double* sums)>& add);

// How badly a start fits: robust mean squares over the squared scale, and a penalty for points that do not take part, or a
// start that sees nothing of the map would win.
double Misfit(const PoseSums& sums, double taking_part, double points, double distance_scale_m, double alpha);

struct PoseStep {
    bool valid = false;         // false where the system is singular or not finite
    Vector6d increment;         // left increment about the local origin
    double gain_change = 0, offset_change = 0;
    double smallest_eigenvalue = 0;  // of the normalised Hessian, see NormalisedHessian
    int held_directions = 0;    // eigenvectors along which the step was set to zero
    Matrix6d held;              // takes an increment's part along them; not set where there are none
    double predicted_decrease = 0;  // of the energy, if it were the quadratic that the step minimises
};

struct SolverOptions {
    bool estimate_brightness = true;
    double brightness_prior = 0;     // weight of "gain 1, offset 0"
    double min_eigenvalue = 0;       // directions below are held, not moved
    bool last_degenerate = false;    // TrackInput's
    double damping = 0;              // of Levenberg-Marquardt: added to the normalised Hessian's eigenvalues
};

// `gain` and `offset` are the present values, which the prior pulls at.
PoseStep SolvePoseStep(const PoseSums& sums, const SolverOptions& options, double gain, double offset,
                     const Eigen::Vector3d& camera_local, double scene_depth_m);

// The pose that the steps found, but along the directions that the last one held, where only noise and the choice of the
// start have moved it: there it is as expected. Both take the camera to the frame that the increments are in.
Eigen::Isometry3d WithHeldAsExpected(const PoseStep& step, const Eigen::Isometry3d& T_local_camera,
                                     const Eigen::Isometry3d& T_local_camera_expected);

// The pose's Hessian made comparable between scenes: increments about the camera, rotations scaled by the scene's
// depth so that both halves are metres, divided by its trace. Its eigenvalues sum to 1.
Matrix6d NormalisedHessian(const Matrix6d& hessian_local, const Eigen::Vector3d& camera_local, double scene_depth_m);

}  // namespace tessera
