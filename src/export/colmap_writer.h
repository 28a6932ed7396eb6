// A scan as COLMAP, and all that read its models (Gaussian splatting among them), take it.
#pragma once

#include <string>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// Writes cameras.txt, images.txt and points3D.txt into `folder`, and images/NNNNNN.jpg (the stored
// bytes) beside them. The world is the scan's; camera axes are COLMAP's own, as ours; poses are
// world to camera. One PINHOLE camera; its principal point counts from the top-left pixel's corner,
// so it is ours plus a half. Points are at most kSeedPoints of the mesh's vertices, without tracks.
// `mesh` is in the scan's world. Errors: no raw frames (it says which key keeps them), a folder
// `images` that holds files already, writing.
Status WriteColmap(const std::string& scan_path, const TriangleMesh& mesh,
                   const std::string& folder);

}  // namespace tessera
