// Meshes a map that is larger than memory, cube by cube from its scan file.
#pragma once

#include <functional>
#include <string>

#include "core/mesh.h"
#include "mapping/mesher.h"

namespace tessera {

// Returns the label of a vertex of a block's mesh, from the map around it. Thread-safe.
using StoredVertexLabel =
    std::function<VertexLabel(const BlockMap&, const BlockMesh&, const BlockMesh::Vertex&)>;

// Returns the same mesh, byte for byte, as Mesher makes of the whole map. With `label`, which may
// be empty, also fills in the vertices' labels. Only some cubes of the map are in memory at a time,
// but the whole mesh is. Errors name the file.
Result<TriangleMesh> MeshOfStoredMap(const std::string& scan_path, const BlockMap::Config& map,
                                     const MeshConfig& meshing,
                                     const StoredVertexLabel& label = {});

}  // namespace tessera
