// The rigid motion between two sets of paired 3D points of which many pairs are wrong.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace tessera {

struct RigidFit {
    Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
    // Positions of the pairs that fit, increasing; empty: no motion was found.
    std::vector<int> inliers;
    // Of the inliers, across their second longest axis: near 0 they lie on a line.
    double spread_m = 0;
};

// Least squares without outliers (Kabsch; Umeyama 1991 without scale): p_a = T_a_b p_b. At least
// three pairs.
Eigen::Isometry3d FitAll(std::span<const Eigen::Vector3f> p_a,
                         std::span<const Eigen::Vector3f> p_b);

// RANSAC over triples with a fixed seed, then least squares over the inliers. A pair fits within
// tolerance_m * max(1, depth / 1 m)^2: a depth camera's noise grows so. Arrays of one length;
// points in camera frames. Thread-safe.
RigidFit FitRigid(std::span<const Eigen::Vector3f> p_a, std::span<const Eigen::Vector3f> p_b,
                  double tolerance_m, int iterations = 500);

}  // namespace tessera
