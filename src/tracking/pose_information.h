// What a frame knows about its pose: the inverse covariance that follows from its residuals' own
// errors, in metres, whatever alpha, image resolution or tracker. docs/information.md has the
// derivation.
#pragma once

#include "core/se3.h"
#include "tracking/pose_solver.h"
#include "tracking/residual_model.h"

namespace tessera {

// Of increments about the camera, in the axes of the local coordinates, a turn counting by how far
// it moves what is `scene_depth_m` away: 1/m^2. Adding residuals never lowers an eigenvalue. Zero
// where the scales are not known. `intensities`: Normalised.
Matrix6d PoseInformation(const ResidualSums& residuals, const PoseTerm& intensities,
                         const ResidualScales& scales, double scene_depth_m);

// Of the distances alone, before division by their variance: what neighbouring patches agree on. A
// patch's mean Jacobian has noise of the map's normals, whose square would look like information on
// a bare wall; products of different patches of a block have not. The square of one-patch blocks is
// left out. Symmetric; noise may leave it slightly indefinite.
Matrix6d AgreedHessian(const std::vector<double>& distance_sums);

// SolverOptions::least_damping for points of which every (2^level)-th in both directions is taken:
// as much as an expectation of that standard deviation would weigh. It slows down motions that the
// frame knows less well and leaves the others alone.
double LeastDamping(const ResidualScales& scales, double expected_within_m, int level);

struct PoseKnowledge {
    double uncertainty_m = 0;  // standard deviation of the motion that is known least
    // Takes a left increment about the local origin to the part of it that is better left as
    // expected: of a motion whose variance is v times the expectation's, v^2 / (1 + v^2).
    Matrix6d open;
};
// `expected_within_m`: standard deviation of what was expected before the frame, all motions; 0:
// nothing was.
PoseKnowledge KnowledgeOf(const Matrix6d& information, double expected_within_m,
                          const Eigen::Vector3d& camera_local, double scene_depth_m);

}  // namespace tessera
