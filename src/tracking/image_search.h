// Exhaustive search for the turn between two tiny images: every shift within a range, for a few
// turns about the optical axis. Its minima are starts for an aligner whose own basin is a pixel or
// so.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

// The rotations (rotation vectors, radians, as the rotation part of T_current_last) with the least
// mean squared difference of the zero-mean intensities: at most `count` separate minima, best
// first. Both images belong to `camera`; pixels below 0 are missing.
std::vector<Eigen::Vector3d> SearchRotations(const Image<float>& last, const Image<float>& current,
                                             const PinholeCamera& camera, int count);

}  // namespace tessera
