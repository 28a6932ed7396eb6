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
inline Matrix6d RootInformation(double sigma_rad, double sigma_m) {
    Vector6d inverse;
    inverse << Eigen::Vector3d::Constant(1 / sigma_rad), Eigen::Vector3d::Constant(1 / sigma_m);
    return inverse.asDiagonal();
}

// Of two keyframes that were found to show one place.
inline PoseEdge LoopEdge(int from, int to, const Eigen::Isometry3d& T_from_to) {
    constexpr double kSigma_m = 0.01, kSigma_rad = 0.005;
    return {from, to, T_from_to, RootInformation(kSigma_rad, kSigma_m), true};
}

// True if this build includes Ceres.
bool PoseGraphAvailable();

// Optimises the poses. The first pose that has an edge stays fixed. All edges use a Cauchy loss,
// for two reasons: a wrong loop has little influence, and where the camera came back with drift,
// tracking may jump from the new surface to the old one. Runs on one thread; deterministic. Error
// if Ceres is missing or finds no usable solution; the poses are then unchanged.
[[nodiscard]] Status OptimisePoses(std::span<const PoseEdge> edges,
                                   std::vector<Eigen::Isometry3d>& T_world_camera);

}  // namespace tessera
