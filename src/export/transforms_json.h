// Exports a scan for nerfstudio, instant-ngp and similar programs: transforms.json with posed
// images.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// These files use a z-up world: ours (y down, z forward) rotated about x.
Eigen::Isometry3d ZUpFromWorld();

// Writes `json_path` and, next to it, images/NNNNNN.jpg (the stored bytes), depth/NNNNNN.png (16
// bits, millimetres along the optical axis, 0 = no measurement) and points.ply (at most kSeedPoints
// of the mesh's vertices, in the z-up world). Camera axes are OpenGL's (x right, y up, z back).
// These programs measure the principal point from the corner of the top-left pixel, so it is ours
// plus a half. Lens coefficients are 0, because the images are ideal. The JSON file is written
// last. `mesh` is in the scan's world. `disparity_offset_per_m`: with which its depth was corrected
// (PreparedFrame::Config), as the depth images then are, too. Frames that cannot be decoded are
// left out; returns what the user should know of them, usually nothing. Errors: no raw frames (the
// error names the key that keeps them), folders that already contain files, write errors.
Result<std::vector<std::string>> WriteTransforms(const std::string& scan_path,
                                                 const TriangleMesh& mesh,
                                                 const std::string& json_path,
                                                 double disparity_offset_per_m = 0);

}  // namespace tessera
