// Where a growing surface is: all of it, or the part of a scan around a point. Owner thread only.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>

namespace tessera {

class SurfaceBounds {
  public:
    // A piece of the surface, world frame, metres.
    void Extend(const Eigen::AlignedBox3d& piece);

    Eigen::AlignedBox3d All() const;
    // Around what belongs to the same part of the scan as this point (see scan_parts.h): the other
    // parts are so far away that nothing is seen of either in a view of all. All of it without a
    // point, and where nothing is near it.
    Eigen::AlignedBox3d Around(const std::optional<Eigen::Vector3d>& p_world) const;

  private:
    // By cube of space: the pieces whose centre is in it.
    std::map<std::array<int, 3>, Eigen::AlignedBox3d> cubes_;
};

}  // namespace tessera
