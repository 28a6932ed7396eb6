// Removes small pieces of a mesh that are connected to nothing: noise in free space.
#pragma once

#include <cstddef>

#include "core/mesh.h"

namespace tessera {

struct RemovedIslands {
    std::size_t islands = 0, triangles = 0;
    double area_m2 = 0;
};

// Removes every connected piece (triangles that share an edge) with an area below `least_m2`, and
// the vertices that are left over. The largest piece stays. Thread-safe.
RemovedIslands RemoveIslands(TriangleMesh& mesh, double least_m2);

}  // namespace tessera
