// Which way is up in a run's world, for the first view of its model.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "core/se3.h"

namespace tessera {

// Unit vector. MeanUp, or the mean of the cameras' upper sides where it is empty; then the
// direction of the floors and tables near it, if the mesh shows enough of them. Without poses: the
// mesh's -y. Thread-safe.
Eigen::Vector3d EstimateUp(const TriangleMesh& mesh, const std::vector<StampedPose>& path);

}  // namespace tessera
