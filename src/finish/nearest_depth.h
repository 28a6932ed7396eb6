// How near the camera came to the places of a scanned surface.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/mesh.h"
#include "core/se3.h"

namespace tessera {

// Per vertex, the depth at which the nearest of the poses has it in its image, metres; what hides
// it is not looked at. Vertices that no pose has get the largest of the others. At most 300 poses
// are used, evenly spaced. Thread-safe; uses all TBB threads.
std::vector<float> NearestDepths_m(const TriangleMesh& mesh, const PinholeCamera& camera,
                                   std::span<const StampedPose> path);

}  // namespace tessera
