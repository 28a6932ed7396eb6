// Takes the sensor's noise off a mesh's surface.
#pragma once

#include <vector>

#include "core/mesh.h"

namespace tessera {

// Smooths by Taubin's lambda | mu filter (Taubin 1995): each round moves a vertex towards the mean
// of its neighbours and then nearly as far back, which takes off ripples of a few edges' length and
// keeps the volume. A vertex at a border follows its neighbours on the border only. `rounds`: per
// vertex. Normals are those of the smoothed surface. Deterministic; thread-safe; uses all TBB
// threads.
void Smooth(TriangleMesh& mesh, const std::vector<int>& rounds);

}  // namespace tessera
