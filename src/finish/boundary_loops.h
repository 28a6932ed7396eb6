// The closed chains of edges at which a mesh ends: round its holes and along its outer rim.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace tessera {

using BoundaryLoop = std::vector<std::uint32_t>;  // vertices, each once

// Seen from outside, a loop goes counter-clockwise round a hole and clockwise round the surface's
// outer rim, so triangles with the loop's own order fill it. A chain that meets itself in a vertex
// is split there. Where two triangles that share an edge disagree about inside and outside, or more
// than two share it, what cannot be followed is left out. Loops of fewer than three edges are left
// out. Time and memory are linear in the mesh, but for the sorting of its edges. Thread-safe.
std::vector<BoundaryLoop> FindBoundaryLoops(const TriangleMesh& mesh);

}  // namespace tessera
