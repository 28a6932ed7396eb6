// First check of a loop: do enough features of two keyframes match and agree on one rigid motion?
#pragma once

#include <string>

#include "optimize/features.h"
#include "optimize/loop_config.h"
#include "optimize/rigid_fit.h"

namespace tessera {

struct FeatureMatch {
    bool accepted = false;
    Eigen::Isometry3d T_old_new = Eigen::Isometry3d::Identity();
    int inliers = 0;
    double spread_m = 0;
};

// Returns pairs (old, new) of mutually nearest descriptors that are clearly nearer than the second
// nearest.
std::vector<std::pair<int, int>> MatchDescriptors(std::span<const Descriptor> old,
                                                  std::span<const Descriptor> fresh);

// Thread-safe.
FeatureMatch MatchFeatures(const Features& old, const Features& fresh, const LoopConfig& config);

}  // namespace tessera
