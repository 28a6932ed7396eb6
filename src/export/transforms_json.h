// A scan as nerfstudio, instant-ngp and their kin read it: transforms.json with posed images.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// The world that such files speak of has z up: ours (y down, z forward) turned about x.
Eigen::Isometry3d ZUpFromWorld();

// Writes `json_path` and, beside it, images/NNNNNN.jpg (the stored bytes), depth/NNNNNN.png (16
// bits, millimetres along the optical axis, 0 = no measurement) and points.ply (at most kSeedPoints
// of the mesh's vertices, in the z-up world). Camera axes are OpenGL's (x right, y up, z back); the
// principal point counts from the top-left pixel's corner, as these programs do, so it is ours plus
// a half; lens coefficients are 0, for the images are ideal. The JSON comes last. `mesh` is in the
// scan's world. Errors: no raw frames (it says which key keeps them), folders that hold files
// already, writing.
Status WriteTransforms(const std::string& scan_path, const TriangleMesh& mesh,
                       const std::string& json_path);

}  // namespace tessera
