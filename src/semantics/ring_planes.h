// The planes that carry or back an object: those that dominate a ring around its box in a depth
// image.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "semantics/detector.h"

namespace tessera {

// Points p in the camera frame with n . p = d; n of unit length.
struct Plane {
    Eigen::Vector3f n = Eigen::Vector3f::UnitZ();
    float d = 0;
};

// How far from a plane a point at depth z still belongs to it: structured light's noise grows with
// z^2.
inline float PlaneTolerance_m(float z_m) { return 0.002f + 0.004f * z_m * z_m; }

// At most three, each with at least an eighth of the ring's points: those of `window` outside `box`
// and outside of the boxes of `others`, whose tops may be level with this object's. A plane that
// only one side of the ring shows counts if it has most of the points: else it is some neighbour.
// RANSAC with a fixed sequence of samples, refined by least squares. Thread-safe.
std::vector<Plane> FindRingPlanes(const DepthImage& depth_m, const PinholeCamera& camera,
                                  const PixelBox& box, const PixelBox& window,
                                  std::span<const PixelBox> others = {});

}  // namespace tessera
