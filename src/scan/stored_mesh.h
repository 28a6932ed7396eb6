// The mesh of a map that is larger than memory: cube by cube from its scan file.
#pragma once

#include <functional>
#include <string>

#include "core/mesh.h"
#include "mapping/mesher.h"

namespace tessera {

// What a vertex of a block's mesh is a part of, from the map around it. Thread-safe.
using StoredVertexLabel =
    std::function<VertexLabel(const BlockMap&, const BlockMesh&, const BlockMesh::Vertex&)>;

// The same mesh, byte for byte, as Mesher makes of the whole map; with `label`, which may be empty,
// its vertices' labels, too. Of the map only some cubes are in memory at a time, but the mesh is
// whole. Errors name the file.
Result<TriangleMesh> MeshOfStoredMap(const std::string& scan_path, const BlockMap::Config& map,
                                     const MeshConfig& meshing,
                                     const StoredVertexLabel& label = {});

}  // namespace tessera
