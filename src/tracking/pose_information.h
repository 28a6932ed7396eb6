// How well a frame constrains its pose: the inverse covariance that follows from the errors of its
// residuals, in metres, independent of alpha, image resolution and tracker. docs/information.md has
// the derivation.
#pragma once

#include "core/se3.h"
#include "tracking/pose_solver.h"
#include "tracking/residual_model.h"

namespace tessera {

// Information matrix, in 1/m^2, of increments about the camera, in the axes of the local
// coordinates. A rotation counts by how far it moves a point at `scene_depth_m`. Adding residuals
// never lowers an eigenvalue. Zero if the scales are unknown. `intensities`: Normalised.
Matrix6d PoseInformation(const ResidualSums& residuals, const PoseTerm& intensities,
                         const ResidualScales& scales, double scene_depth_m);

// Hessian of the distances alone, before division by their variance: what neighbouring patches
// agree on. A patch's mean Jacobian contains noise from the map's normals, whose square would look
// like information on a bare wall. Products of different patches of a block do not contain it.
// Blocks of one patch are left out. Symmetric; noise may leave it slightly indefinite.
Matrix6d AgreedHessian(const std::vector<double>& distance_sums);

// SolverOptions::least_damping for points at every (2^level)-th pixel in both directions: weighs as
// much as a pose prior of that standard deviation. It slows down motions that the frame constrains
// less well and leaves the others alone.
double LeastDamping(const ResidualScales& scales, double expected_within_m, int level);

struct PoseUncertainty {
    double uncertainty_m = 0;  // standard deviation of the least constrained motion
    // Maps a left increment about the local origin to the part of it that should keep its prior:
    // the fraction v^2 / (1 + v^2) of a motion whose variance is v times that of the prior.
    Matrix6d open;
};
// `expected_within_m`: standard deviation of the pose prior before the frame, for all motions; 0:
// no prior.
PoseUncertainty ComputeUncertainty(const Matrix6d& information, double expected_within_m,
                                   const Eigen::Vector3d& camera_local, double scene_depth_m);

}  // namespace tessera
