// Points spread evenly over a mesh, however its triangles are cut: a decimated mesh and a fresh one
// give the same plan. Pure function, thread-safe.
#pragma once

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

struct MeshSamples {
    TriangleMesh surface;     // vertices and unit normals, no triangles
    double spacing_m = 0;     // each stands for spacing_m^2 of surface
    std::size_t skipped = 0;  // triangles that are not finite or lie absurdly far off
};

// At most about six million points, 1 cm apart if that suffices. Normals are those of the vertices
// where triangles are small and have some. Errors: no triangle, or more surface than a building has
// (a mesh in millimetres).
Result<MeshSamples> SampleMesh(const TriangleMesh& mesh);

}  // namespace tessera
