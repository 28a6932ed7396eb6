// The length of a camera's path.
#pragma once

#include <span>

#include "core/se3.h"

namespace tessera {

// Sum of the distances from each pose to the next, metres.
inline double PathLength_m(std::span<const StampedPose> path) {
    double length_m = 0;
    for (std::size_t i = 1; i < path.size(); ++i)
        length_m +=
            (path[i].T_world_camera.translation() - path[i - 1].T_world_camera.translation())
                .norm();
    return length_m;
}

}  // namespace tessera
