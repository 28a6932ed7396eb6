// Exhaustive search for the rotation between two tiny images: every shift within a range, for a few
// rotations about the optical axis. Its minima are starts for an aligner whose own convergence
// basin is about a pixel.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

// Returns the rotations (rotation vectors in radians, for the rotation part of T_current_last) with
// the least mean squared difference of the zero-mean intensities: at most `count` separate minima,
// best first. Both images belong to `camera`; pixels below 0 are missing.
std::vector<Eigen::Vector3d> SearchRotations(const Image<float>& last, const Image<float>& current,
                                             const PinholeCamera& camera, int count);

}  // namespace tessera
