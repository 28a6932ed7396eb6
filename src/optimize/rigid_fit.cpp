#include "optimize/rigid_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/check.h"
#include "core/se3.h"

namespace tessera {
namespace {

using Points = std::span<const Eigen::Vector3f>;

std::vector<Eigen::Vector3f> Chosen(Points points, std::span<const int> which) {
    std::vector<Eigen::Vector3f> chosen;
    for (const int i : which) chosen.push_back(points[static_cast<std::size_t>(i)]);
    return chosen;
}

Eigen::Isometry3d FitSome(Points p_a, Points p_b, std::span<const int> which) {
    return FitAll(Chosen(p_a, which), Chosen(p_b, which));
}

std::vector<int> Inliers(Points p_a, Points p_b, const Eigen::Isometry3d& T_a_b,
                         double tolerance_m) {
    const Eigen::Isometry3f T = T_a_b.cast<float>();
    std::vector<int> inliers;
    for (std::size_t i = 0; i < p_a.size(); ++i) {
        const float depth = std::max({1.0f, p_a[i].z(), p_b[i].z()});
        if ((p_a[i] - T * p_b[i]).norm() <= static_cast<float>(tolerance_m) * depth * depth)
            inliers.push_back(static_cast<int>(i));
    }
    return inliers;
}

// Cheap test: most wrong triples differ in the lengths of their sides.
bool SameTriangle(Points p_a, Points p_b, const int (&triple)[3], double tolerance_m) {
    for (int i = 0; i < 3; ++i) {
        const auto m = static_cast<std::size_t>(triple[i]),
                   n = static_cast<std::size_t>(triple[(i + 1) % 3]);
        const float a = (p_a[m] - p_a[n]).norm(), b = (p_b[m] - p_b[n]).norm();
        const float depth = std::max({1.0f, p_a[m].z(), p_a[n].z()});
        if (a < 0.1f || std::abs(a - b) > 2 * static_cast<float>(tolerance_m) * depth * depth)
            return false;
    }
    return true;
}

double Spread(Points points, std::span<const int> which) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int i : which) mean += points[static_cast<std::size_t>(i)].cast<double>();
    mean /= static_cast<double>(which.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const int i : which) {
        const Eigen::Vector3d d = points[static_cast<std::size_t>(i)].cast<double>() - mean;
        covariance += d * d.transpose() / static_cast<double>(which.size());
    }
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()(1));
}

}  // namespace

Eigen::Isometry3d FitAll(Points p_a, Points p_b) {
    TESSERA_CHECK(p_a.size() == p_b.size() && p_a.size() >= 3, "{} and {} points", p_a.size(),
                  p_b.size());
    Eigen::Matrix3Xd a(3, p_a.size()), b(3, p_b.size());
    for (std::size_t i = 0; i < p_a.size(); ++i) {
        a.col(static_cast<Eigen::Index>(i)) = p_a[i].cast<double>();
        b.col(static_cast<Eigen::Index>(i)) = p_b[i].cast<double>();
    }
    Eigen::Isometry3d T;
    T.matrix() = Eigen::umeyama(b, a, false);
    return Normalised(T);
}

RigidFit FitRigid(Points p_a, Points p_b, double tolerance_m, int iterations) {
    constexpr int kRefinements = 3;
    RigidFit best;
    if (p_a.size() < 3) return best;
    std::mt19937 random(7);
    for (int iteration = 0; iteration < iterations; ++iteration) {
        int triple[3];
        for (int& i : triple) i = static_cast<int>(random() % p_a.size());
        if (!SameTriangle(p_a, p_b, triple, tolerance_m)) continue;
        const Eigen::Isometry3d T = FitSome(p_a, p_b, triple);
        std::vector<int> inliers = Inliers(p_a, p_b, T, tolerance_m);
        if (inliers.size() > best.inliers.size()) best = {T, std::move(inliers), 0};
    }
    for (int i = 0; i < kRefinements && best.inliers.size() >= 3; ++i) {
        best.T_a_b = FitSome(p_a, p_b, best.inliers);
        best.inliers = Inliers(p_a, p_b, best.T_a_b, tolerance_m);
    }
    if (best.inliers.size() < 3) best.inliers.clear();
    if (!best.inliers.empty()) best.spread_m = Spread(p_a, best.inliers);
    return best;
}

}  // namespace tessera
