// Which map a pose is in: loops correct a map and resets begin new ones while frames are under way
// between threads.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "core/se3.h"

namespace tessera {

// Resets begin new worlds, and within one loops correct the map so and so often.
struct MapVersion {
    int world = 0, corrections = 0;

    bool operator==(const MapVersion&) const = default;
};

// Brings the pose of a camera in a map after `from` corrections to the map after all of them,
// T_new_old each.
inline void Carry(const std::vector<Eigen::Isometry3d>& corrections, int from,
                  Eigen::Isometry3d& T_world_camera) {
    for (auto i = static_cast<std::size_t>(from); i < corrections.size(); ++i)
        T_world_camera = Normalised(corrections[i] * T_world_camera);
}

}  // namespace tessera
