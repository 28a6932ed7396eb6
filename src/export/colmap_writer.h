// Exports a scan in COLMAP's format, which many programs read (Gaussian splatting among them).
#pragma once

#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// Writes cameras.txt, images.txt and points3D.txt to `folder`, and the stored JPEGs to
// images/NNNNNN.jpg. The world frame is the scan's. Camera axes are the same as COLMAP's; poses are
// world to camera. There is one PINHOLE camera. COLMAP measures the principal point from the corner
// of the top-left pixel, so it is ours plus a half. Points are at most kSeedPoints of the mesh's
// vertices, without tracks. `mesh` is in the scan's world. Frames that cannot be decoded are left
// out; returns what the user should know of them, usually nothing. Errors: no raw frames (the error
// names the key that keeps them), a folder `images` that already contains files, write errors.
Result<std::vector<std::string>> WriteColmap(const std::string& scan_path, const TriangleMesh& mesh,
                                             const std::string& folder);

}  // namespace tessera
