// Associates the poses of two trajectories and computes the rigid alignment between them, as
// defined by the TUM RGB-D tools (associate.py, evaluate_ate.py).
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "core/se3.h"
#include "core/status.h"

namespace tessera {

struct PosePair {
    std::size_t reference = 0, estimate = 0;  // indices
    bool operator==(const PosePair&) const = default;
};

// Greedy association: takes the closest of all pairs less than max_difference_s apart first. Each
// pose is used once; ties go to the earlier reference pose. Both lists must have strictly
// increasing stamps. The result is sorted by time. O(n log n) for any input. Thread-safe.
std::vector<PosePair> AssociateByTime(const std::vector<StampedPose>& reference,
                                      const std::vector<StampedPose>& estimate,
                                      double max_difference_s = 0.02);

struct Alignment {
    Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();
    std::vector<PosePair> pairs;
    // Set if the positions barely determine the rotation (the camera stood still or moved along a
    // line); empty otherwise.
    std::string warning;
};

// The rotation and translation, without scale, that minimise the squared distances between paired
// positions (Horn 1987, Umeyama 1991, closed form). Fewer than three pairs are an error that says
// whether the trajectories are empty, apart in time or too short. Thread-safe.
Result<Alignment> AlignTrajectories(const std::vector<StampedPose>& reference,
                                    const std::vector<StampedPose>& estimate,
                                    double max_difference_s = 0.02);

}  // namespace tessera
