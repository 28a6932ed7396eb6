// PLY input and output. Writes binary little endian; reads ASCII and binary of either byte order.
#pragma once

#include <string>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// Writes vertices, plus normals, colours and labels (class, instance) if the mesh has them. Writes
// to a temporary file and renames it, so an existing file is never left half overwritten.
Status WritePly(const std::string& path, const TriangleMesh& mesh);

// Splits polygons into triangles and skips unknown properties. Checks element counts against the
// file size before allocating anything.
Result<TriangleMesh> ReadPly(const std::string& path);

}  // namespace tessera
