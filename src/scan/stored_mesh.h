// The mesh of a map that is larger than memory: cube by cube from its scan file.
#pragma once

#include <string>

#include "core/mesh.h"
#include "mapping/mesher.h"

namespace tessera {

// The same mesh, byte for byte, as Mesher makes of the whole map. Of the map only some cubes are in memory at a time, but the
// mesh is whole. Errors name the file.
Result<TriangleMesh> MeshOfStoredMap(const std::string& scan_path, const BlockMap::Config& map, const MeshConfig& meshing);

}  // namespace tessera
