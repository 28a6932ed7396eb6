// Pose graph of the keyframes: nonlinear least squares over their poses with Ceres.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/se3.h"
#include "core/status.h"

namespace tessera {

// Constraint between two keyframes: pose of camera `to` in the frame of camera `from`.
struct PoseEdge {
    int from = 0, to = 0;
    Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
    // Square root R of the inverse covariance R^T R of a right increment (rotation, translation).
    Matrix6d root_information = Matrix6d::Identity();
    bool loop = false;  // not from consecutive tracking
};

// Root of the information of independent increments with these standard deviations about and along
// each axis.
Matrix6d RootInformation(double sigma_rad, double sigma_m);

// Residual of one edge in standard deviations: root_information times the error, which is the
// rotation (twice the vector part of the error quaternion), then the translation, of
// T_from_to^-1 T_world_from^-1 T_world_to.
Vector6d EdgeResidual(const PoseEdge& edge, const Eigen::Isometry3d& T_world_from,
                      const Eigen::Isometry3d& T_world_to);

struct PoseGraphReport {
    int iterations = 0;
    double initial_cost = 0, final_cost = 0;
};

// True if this build includes Ceres.
bool PoseGraphAvailable();

// Optimises the poses. The first pose that has an edge stays fixed. All edges use a Cauchy loss,
// for two reasons: a wrong loop has little influence, and where the camera came back with drift,
// tracking may jump from the new surface to the old one. Runs on one thread; deterministic. Error
// if Ceres is missing or finds no usable solution; the poses are then unchanged.
Result<PoseGraphReport> OptimisePoses(std::span<const PoseEdge> edges,
                                      std::vector<Eigen::Isometry3d>& T_world_camera);

// For tests: largest difference between Ceres' Jacobian of one edge and central differences,
// relative to the largest Jacobian entry.
double EdgeJacobianError(const PoseEdge& edge, const Eigen::Isometry3d& T_world_from,
                         const Eigen::Isometry3d& T_world_to);

}  // namespace tessera
