// How near the camera came to the places of a scanned surface, and how uncertain they are.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/mesh.h"
#include "core/se3.h"

namespace tessera {

// Standard deviation of a depth camera's measurement at `depth_m`, metres: axial noise of a Kinect
// (Nguyen et al. 2012), which measures from 0.4 m on.
inline float DepthSigma_m(float depth_m) {
    const float beyond_m = depth_m > 0.4f ? depth_m - 0.4f : 0.0f;
    return 0.0012f + 0.0019f * beyond_m * beyond_m;
}

// Per vertex, the depth at which the nearest of the poses has it in its image, metres; what hides
// it is not looked at. Vertices that no pose has get the largest of the others. At most 300 poses
// are used, evenly spaced. Thread-safe; uses all TBB threads.
std::vector<float> NearestDepths_m(const TriangleMesh& mesh, const PinholeCamera& camera,
                                   std::span<const StampedPose> path);

}  // namespace tessera
