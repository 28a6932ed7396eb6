#include "viz/surface_bounds.h"

#include <cmath>

#include "optimize/scan_parts.h"

namespace tessera {

void SurfaceBounds::Extend(const Eigen::AlignedBox3d& piece) {
    constexpr double kCube_m = 50;
    const Eigen::Vector3d at = piece.center() / kCube_m;
    const auto floor = [&](int axis) { return static_cast<int>(std::floor(at[axis])); };
    cubes_[{floor(0), floor(1), floor(2)}].extend(piece);
}

Eigen::AlignedBox3d SurfaceBounds::All() const {
    Eigen::AlignedBox3d all;
    for (const auto& [cube, box] : cubes_) all.extend(box);
    return all;
}

Eigen::AlignedBox3d SurfaceBounds::Around(const std::optional<Eigen::Vector3d>& p_world) const {
    Eigen::AlignedBox3d near;
    if (p_world)
        for (const auto& [cube, box] : cubes_)
            if (box.exteriorDistance(*p_world) < kPartsApart_m / 2) near.extend(box);
    return near.isEmpty() ? All() : near;
}

}  // namespace tessera
