// Removes small pieces of a mesh that are connected to nothing: noise in free space.
#pragma once

#include <cstddef>
#include <vector>

#include "core/mesh.h"

namespace tessera {

struct RemovedIslands {
    std::size_t islands = 0, triangles = 0;
    double area_m2 = 0;
};

// Removes every connected piece (triangles that share an edge) with an area below `least_m2`, and
// the vertices that are left over. The largest piece stays. Thread-safe.
RemovedIslands RemoveIslands(TriangleMesh& mesh, double least_m2);
// `sigmas_m`: the standard deviation of the depth at each vertex. Where it is more than 2 mm, an
// area counts as much less as the variance is more, up to 20 times: where depth is noisier, larger
// pieces are noise. Keeps those of the vertices that stay.
RemovedIslands RemoveIslands(TriangleMesh& mesh, double least_m2, std::vector<float>& sigmas_m);

}  // namespace tessera
