// Which way is up in a run's world, roughly, from how its cameras were held.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/mesh.h"
#include "core/se3.h"

namespace tessera {

// Unit vector: up from how the cameras were held on average: upright, unless their x axis keeps its
// direction much better; then they were held sideways, and the mesh's normals tell on which side.
// Empty without poses, and if the cameras were turned in every direction. Thread-safe.
std::optional<Eigen::Vector3d> MeanUp(const std::vector<StampedPose>& path,
                                      const TriangleMesh& mesh);

}  // namespace tessera
