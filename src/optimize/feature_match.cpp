#include "optimize/feature_match.h"

#include <algorithm>

namespace tessera {
namespace {

struct Nearest {
    int index = -1;
    int distance = 257, second = 257;

    void See(int candidate, int d) {
        if (d < distance) {
            second = distance;
            distance = d;
            index = candidate;
        } else if (d < second) {
            second = d;
        }
    }
};

double MedianDepth_m(std::span<const Eigen::Vector3f> p_camera, std::span<const int> which) {
    std::vector<float> depths_m;
    for (const int i : which) depths_m.push_back(p_camera[static_cast<std::size_t>(i)].z());
    const auto middle = depths_m.begin() + std::ssize(depths_m) / 2;
    std::nth_element(depths_m.begin(), middle, depths_m.end());
    return *middle;
}

}  // namespace

std::vector<std::pair<int, int>> MatchDescriptors(std::span<const Descriptor> old,
                                                  std::span<const Descriptor> fresh) {
    constexpr int kMaxDistance = 64;
    constexpr double kRatio = 0.85;
    std::vector<Nearest> of_old(old.size()), of_fresh(fresh.size());
    for (std::size_t i = 0; i < old.size(); ++i)
        for (std::size_t j = 0; j < fresh.size(); ++j) {
            const int distance = HammingDistance(old[i], fresh[j]);
            of_old[i].See(static_cast<int>(j), distance);
            of_fresh[j].See(static_cast<int>(i), distance);
        }
    std::vector<std::pair<int, int>> pairs;
    for (std::size_t i = 0; i < old.size(); ++i) {
        const Nearest& nearest = of_old[i];
        if (nearest.index < 0 || nearest.distance > kMaxDistance ||
            nearest.distance >= kRatio * nearest.second)
            continue;
        if (of_fresh[static_cast<std::size_t>(nearest.index)].index == static_cast<int>(i))
            pairs.emplace_back(static_cast<int>(i), nearest.index);
    }
    return pairs;
}

std::optional<Eigen::Isometry3d> MatchFeatures(const Features& old, const Features& fresh,
                                               const LoopConfig& config) {
    constexpr double kTolerance_m = 0.025, kWholeSpread_m = 1;
    std::vector<Eigen::Vector3f> p_old, p_new;
    for (const auto& [i, j] : MatchDescriptors(old.descriptors, fresh.descriptors)) {
        p_old.push_back(old.p_camera[static_cast<std::size_t>(i)]);
        p_new.push_back(fresh.p_camera[static_cast<std::size_t>(j)]);
    }
    if (std::ssize(p_old) < config.min_inliers) return std::nullopt;
    const RigidFit fit = FitRigid(p_old, p_new, kTolerance_m);
    if (std::ssize(fit.inliers) < config.min_inliers) return std::nullopt;
    // What a camera sees of a near surface is small.
    const double nearness = std::min(1.0, MedianDepth_m(p_old, fit.inliers) / kWholeSpread_m);
    if (fit.spread_m < config.min_spread_m * nearness) return std::nullopt;
    return fit.T_a_b;
}

}  // namespace tessera
