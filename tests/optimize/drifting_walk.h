// A walk around the furnished room with odometry that drifts.
#pragma once

#include <cstddef>
#include <vector>

#include "core/se3.h"
#include "optimize/room_walk.h"

namespace tessera::testing_support {

// One full turn and a little more, every sixth frame.
inline std::vector<Frame> Round() { return RoomWalk(0, 120, 6); }

// Odometry error between two frames: 1.5 mm and 0.05 degrees, or this share of it, always in the
// same direction.
inline Eigen::Isometry3d Bias(double share = 1) {
    return Se3Exp((Vector6d() << 0, 0.0009, 0, 0.0015, 0, 0).finished() * share);
}

inline void WalkWithDrift(const std::vector<Frame>& frames, Walker& walker, double share = 1) {
    for (std::size_t i = 0; i < frames.size(); ++i)
        walker.Go(frames[i], i == 0 ? Eigen::Isometry3d::Identity()
                                    : frames[i - 1].T_world_camera->inverse() *
                                          *frames[i].T_world_camera * Bias(share));
}

inline double EndError_m(const std::vector<Frame>& frames, const std::vector<StampedPose>& path) {
    return (path.back().T_world_camera.translation() - frames.back().T_world_camera->translation())
        .norm();
}

}  // namespace tessera::testing_support
