// Simplifies a large mesh for a picture of the whole.
#pragma once

#include <cstddef>

#include "core/mesh.h"

namespace tessera {

// Merges all vertices in each cell of a grid of `cell_m` into the first one. Drops triangles that
// become degenerate.
TriangleMesh CoarseMesh(const TriangleMesh& mesh, double cell_m);

// The same, with a cell size that leaves about `most_triangles` at most. Only for a mesh that has
// more.
TriangleMesh CoarseMeshOf(const TriangleMesh& mesh, std::size_t most_triangles);

}  // namespace tessera
