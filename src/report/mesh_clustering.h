// Makes a mesh small enough for a page. Pure functions, thread-safe; the result does not depend on
// the number of threads.
#pragma once

#include <cstddef>

#include "core/mesh.h"

namespace tessera {

// Merges the vertices in each cell of a grid of `cell_m` into their mean (position, normal,
// colour); the label is the first vertex's. Drops triangles that become degenerate, and vertices
// that are not finite together with their triangles. cell_m > 0.
TriangleMesh ClusterVertices(const TriangleMesh& mesh, double cell_m);

struct ReducedMesh {
    TriangleMesh mesh;
    double cell_m = 0;  // of the grid; 0: the mesh is as it was
};

// At most `most_triangles` triangles, or as many points if the mesh has no triangles (then every
// n-th). A mesh that has no more is returned unchanged.
ReducedMesh ReduceMesh(TriangleMesh mesh, std::size_t most_triangles);

}  // namespace tessera
