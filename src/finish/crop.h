// The part of a mesh that lies in a box.
#pragma once

#include <Eigen/Geometry>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// Cuts the mesh along the box's sides: triangles that cross one are divided there, with normals and
// colours between those of their corners, and labels of the corner inside. Error: nothing is left;
// it says where the mesh is. Thread-safe for distinct meshes.
Status CropMesh(const Eigen::AlignedBox3d& box_m, TriangleMesh& mesh);

}  // namespace tessera
