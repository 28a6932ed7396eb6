// Finds the planes that support an object or lie behind it: those that dominate a ring around its
// box in the depth image.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "semantics/detector.h"

namespace tessera {

// Points p in the camera frame with n . p = d; n has unit length.
struct Plane {
    Eigen::Vector3f n = Eigen::Vector3f::UnitZ();
    float d = 0;
};

// Maximum distance from a plane at which a point at depth z still belongs to it. The noise of
// structured light grows with z^2.
inline float PlaneTolerance_m(float z_m) { return 0.002f + 0.004f * z_m * z_m; }

// Finds at most three planes, each with at least an eighth of the ring's points. The ring is
// `window` without `box` and without the boxes of `others`, whose tops may be level with this
// object. A plane seen on only one side of the ring counts only if it holds at least half of the
// points; otherwise it belongs to a neighbour. RANSAC with a fixed sample sequence, refined by
// least squares. Thread-safe.
std::vector<Plane> FindRingPlanes(const DepthImage& depth_m, const PinholeCamera& camera,
                                  const PixelBox& box, const PixelBox& window,
                                  std::span<const PixelBox> others = {});

}  // namespace tessera
