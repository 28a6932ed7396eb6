// From the sums over all points to a step: the Gauss-Newton solution of [B14] eq. 11 with the
// frame's brightness eliminated.
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

// Calls add(first, last, sums) for runs of at most kRunItems points (core/tile_sums.h), on all
// threads, and adds up what they leave in their order: the same bytes for any number of threads.
PoseSums SumPoints(int count, const std::function<void(int first, int last, double* sums)>& add);

// How badly a start fits: robust mean squares over the squared scale, and a penalty for points that
// do not take part, or a start that sees nothing of the map would win.
double Misfit(const PoseSums& sums, double taking_part, double points, double distance_scale_m,
              double alpha);

struct PoseStep {
    bool valid = false;  // false where the system is singular or not finite
    Vector6d increment;  // left increment about the local origin
    double gain_change = 0, offset_change = 0;
    // Of the energy, if it were the quadratic that the step minimises.
    double predicted_decrease = 0;
};

struct SolverOptions {
    double alpha = 0;  // of [B14] eq. 8
    bool estimate_brightness = true;
    double brightness_prior = 0;  // weight of "gain 1, offset 0", as intensities are weighted
    // Of Levenberg-Marquardt: added to the normalised Hessian's eigenvalues, as a share of the
    // trace.
    double damping = 0;
    // Added likewise, per square metre: motions that nothing shows do not run away.
    double least_damping = 0;
};

// `gain` and `offset` are the present values, which the prior pulls at.
PoseStep SolvePoseStep(const PoseSums& sums, const SolverOptions& options, double gain,
                       double offset, const Eigen::Vector3d& camera_local, double scene_depth_m);

// The intensities' Hessian of the pose, without alpha, the frame's brightness eliminated by its
// Schur complement, so that it takes from the pose what it explains. Positive semidefinite.
Matrix6d IntensityHessian(const PoseSums& sums, double brightness_prior);

// Hessian and gradient of one kind of residuals, of increments about the local origin, without
// alpha.
struct PoseTerm {
    Matrix6d H;
    Vector6d g;

    // Of increments about the camera with rotations in units of 1 / depth, so that both halves are
    // metres.
    PoseTerm Normalised(const Eigen::Vector3d& camera_local, double scene_depth_m) const;
};
PoseTerm DistanceTerm(const PoseSums& sums);
// The frame's brightness is eliminated by its Schur complement, so that it takes from the pose what
// it explains, unless it is not estimated. Positive semidefinite.
PoseTerm IntensityTerm(const PoseSums& sums, const SolverOptions& options, double gain,
                       double offset);

// Takes an increment about the camera with rotations in units of 1 / depth to one about the local
// origin.
Matrix6d FromNormalised(const Eigen::Vector3d& camera_local, double scene_depth_m);

}  // namespace tessera
