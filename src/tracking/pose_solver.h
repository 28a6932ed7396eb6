// Solves the sums over all points for a step: the Gauss-Newton solution of [B14] eq. 11 with the
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

// Robust root mean square of the intensity residuals; 0 if there are none.
double IntensityRms(const PoseSums& sums);

// Calls add(first, last, sums) for ranges of at most kRunItems points (core/tile_sums.h), on all
// threads, and adds the results in order: the same bytes for any number of threads.
PoseSums SumPoints(int count, const std::function<void(int first, int last, double* sums)>& add);

// How badly a start fits: robust mean squares over the squared scale, plus a penalty for points
// that do not take part. Without the penalty, a start that sees nothing of the map would win.
double Misfit(const PoseSums& sums, double taking_part, double points, double distance_scale_m,
              double alpha);

struct PoseStep {
    bool valid = false;  // false if the system is singular or not finite
    Vector6d increment;  // left increment about the local origin
    double gain_change = 0, offset_change = 0;
    // The decrease of the energy if it were the quadratic that the step minimises.
    double predicted_decrease = 0;
};

struct SolverOptions {
    double alpha = 0;  // of [B14] eq. 8
    bool estimate_brightness = true;
    // weight of the prior "gain 1, offset 0", in units of intensity weights
    double brightness_prior = 0;
    // Levenberg-Marquardt damping: added to the eigenvalues of the normalised Hessian, as a
    // fraction of the trace.
    double damping = 0;
    // Added likewise, per square metre, so that unobservable motions do not run away.
    double least_damping = 0;
};

// `gain` and `offset` are the current values, on which the prior acts.
PoseStep SolvePoseStep(const PoseSums& sums, const SolverOptions& options, double gain,
                       double offset, const Eigen::Vector3d& camera_local, double scene_depth_m);

// Hessian and gradient of one kind of residuals, for increments about the local origin, without
// alpha.
struct PoseTerm {
    Matrix6d H;
    Vector6d g;

    // For increments about the camera with rotations in units of 1 / depth, so that both halves are
    // in metres.
    PoseTerm Normalised(const Eigen::Vector3d& camera_local, double scene_depth_m) const;
};
PoseTerm DistanceTerm(const PoseSums& sums);
// Eliminates the frame's brightness, if it is estimated, by its Schur complement, so that what
// brightness explains does not count for the pose. Positive semidefinite.
PoseTerm IntensityTerm(const PoseSums& sums, const SolverOptions& options, double gain,
                       double offset);

// Maps an increment about the camera, with rotations in units of 1 / depth, to one about the local
// origin.
Matrix6d FromNormalised(const Eigen::Vector3d& camera_local, double scene_depth_m);

}  // namespace tessera
