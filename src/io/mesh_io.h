// PLY in and out. Writing is binary little endian; reading takes ASCII and binary of either byte
// order.
#pragma once

#include <string>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// Vertices with normals, colours and labels (class, instance) where the mesh has them. Written
// beside the target and renamed, so that an existing file is never half overwritten.
Status WritePly(const std::string& path, const TriangleMesh& mesh);

// Polygons are split into triangles, unknown properties skipped. Element counts are checked against
// the file's size before anything is allocated.
Result<TriangleMesh> ReadPly(const std::string& path);

}  // namespace tessera
