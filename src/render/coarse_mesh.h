// A large mesh made small enough for a picture of all of it.
#pragma once

#include <cstddef>

#include "core/mesh.h"

namespace tessera {

// Of the vertices in each cell of a grid of `cell_m` only the first stays, for all of them;
// triangles that lose a corner go.
TriangleMesh CoarseMesh(const TriangleMesh& mesh, double cell_m);

// The same, in cells as small as leave at most `most_triangles`, about. Only for a mesh that has
// more.
TriangleMesh CoarseMeshOf(const TriangleMesh& mesh, std::size_t most_triangles);

}  // namespace tessera
