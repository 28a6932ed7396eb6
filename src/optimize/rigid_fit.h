// Rigid motion between two sets of paired 3D points with many wrong pairs.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace tessera {

struct RigidFit {
    Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
    // Indices of the pairs that fit, increasing; empty if no motion was found.
    std::vector<int> inliers;
    // Spread of the inliers along their second longest axis; near 0 if they lie on a line.
    double spread_m = 0;
};

// Least squares without outlier rejection (Kabsch; Umeyama 1991 without scale): p_a = T_a_b p_b.
// Needs at least three pairs.
Eigen::Isometry3d FitAll(std::span<const Eigen::Vector3f> p_a,
                         std::span<const Eigen::Vector3f> p_b);

// RANSAC over triples with a fixed seed, then least squares over the inliers. A pair fits within
// tolerance_m * max(1, depth / 1 m)^2, because the noise of depth cameras grows this way. Arrays of
// equal length; points in camera frames. Thread-safe.
RigidFit FitRigid(std::span<const Eigen::Vector3f> p_a, std::span<const Eigen::Vector3f> p_b,
                  double tolerance_m, int iterations = 500);

}  // namespace tessera
