// First check of a loop: do enough features of two keyframes match and agree on one rigid motion?
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "optimize/features.h"
#include "optimize/loop_config.h"
#include "optimize/rigid_fit.h"

namespace tessera {

// Returns pairs (old, new) of mutually nearest descriptors that are clearly nearer than the second
// nearest.
std::vector<std::pair<int, int>> MatchDescriptors(std::span<const Descriptor> old,
                                                  std::span<const Descriptor> fresh);

// Returns T_old_new; empty if too few agree, or if they lie too close together. Thread-safe.
std::optional<Eigen::Isometry3d> MatchFeatures(const Features& old, const Features& fresh,
                                               const LoopConfig& config);

}  // namespace tessera
