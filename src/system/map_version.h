// Identifies the map that a pose refers to. Loops correct a map, and resets start new ones, while
// frames are in transit between threads.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "core/se3.h"

namespace tessera {

// `world` counts resets; `corrections` counts loop corrections within that world.
struct MapVersion {
    int world = 0, corrections = 0;

    bool operator==(const MapVersion&) const = default;
};

// Carries a camera pose from the map after `from` corrections to the map after all of them. Each
// correction is a T_new_old.
inline void Carry(const std::vector<Eigen::Isometry3d>& corrections, int from,
                  Eigen::Isometry3d& T_world_camera) {
    for (auto i = static_cast<std::size_t>(from); i < corrections.size(); ++i)
        T_world_camera = Normalised(corrections[i] * T_world_camera);
}

}  // namespace tessera
