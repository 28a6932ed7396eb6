// Which poses of two trajectories belong together, and the rigid motion that lays one onto the
// other, as the TUM RGB-D tools (associate.py, evaluate_ate.py) define both.
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

// Greedy: of all pairs less than max_difference_s apart the closest first, each pose used once;
// ties go to the earlier reference. Both lists have strictly increasing stamps. Sorted by time.
// O(n log n) for any input. Thread-safe.
std::vector<PosePair> AssociateByTime(const std::vector<StampedPose>& reference,
                                      const std::vector<StampedPose>& estimate,
                                      double max_difference_s = 0.02);

struct Alignment {
    Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();
    std::vector<PosePair> pairs;
    // Not empty if positions alone hardly determine the rotation (the camera stood, or moved along
    // a line): says so.
    std::string warning;
};

// The rotation and translation, without scale, that minimise the squared distances between the
// paired positions (Horn 1987, Umeyama 1991, closed form). Fewer than three pairs are an error
// that says whether the trajectories are empty, apart in time or too short. Thread-safe.
Result<Alignment> AlignTrajectories(const std::vector<StampedPose>& reference,
                                    const std::vector<StampedPose>& estimate,
                                    double max_difference_s = 0.02);

}  // namespace tessera
