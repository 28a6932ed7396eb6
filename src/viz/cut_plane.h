// The plane behind which the 3D view hides the surface. A pure function, thread-safe.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "viz/viewer_state.h"

namespace tessera {

// (n, d): points with n^T p + d < 0 are hidden; world frame, metres. `bounds`: of the surface;
// `up`: unit vector. nullopt: nothing is cut.
std::optional<Eigen::Vector4d> CutPlane(const ViewChoices& view, const Eigen::AlignedBox3d& bounds,
                                        const Eigen::Vector3d& up);

}  // namespace tessera
