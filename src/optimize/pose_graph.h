// Where keyframes belong when loops have been closed: nonlinear least squares over their poses by
// Ceres.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/se3.h"
#include "core/status.h"

namespace tessera {

// What is known of two keyframes' places: camera `to` in the frame of camera `from`.
struct PoseEdge {
    int from = 0, to = 0;
    Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
    double sigma_m = 0.01, sigma_rad = 0.01;  // standard deviation along and about each axis
    bool loop = false;                        // not from tracking one after the other
};

// The residual of one edge in standard deviations: rotation (twice the vector part of the error's
// quaternion), then translation, of T_from_to^-1 T_world_from^-1 T_world_to.
Vector6d EdgeResidual(const PoseEdge& edge, const Eigen::Isometry3d& T_world_from,
                      const Eigen::Isometry3d& T_world_to);

struct PoseGraphReport {
    int iterations = 0;
    double initial_cost = 0, final_cost = 0;
};

// Whether this build has Ceres.
bool PoseGraphAvailable();

// Moves the poses so that the edges are met best. Pose 0 stays. All are under a Cauchy loss: a
// wrong loop that slipped through pulls little, and where the camera came back with drift, tracking
// jumps from the new surface to the old one, a motion that never was. One thread, so the result is
// the same on every run. An error where Ceres is missing or finds no usable solution; the poses are
// then as they were.
Result<PoseGraphReport> OptimisePoses(std::span<const PoseEdge> edges,
                                      std::vector<Eigen::Isometry3d>& T_world_camera);

// How far Ceres' Jacobian of one edge is from central differences, the largest entry, relative to
// the largest Jacobian entry: for tests.
double EdgeJacobianError(const PoseEdge& edge, const Eigen::Isometry3d& T_world_from,
                         const Eigen::Isometry3d& T_world_to);

}  // namespace tessera
