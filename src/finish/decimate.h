// Fewer triangles within a bound of the error, by quadric error metrics (Garland and Heckbert
// 1997), as meshoptimizer implements them.
#pragma once

#include <vector>

#include "core/mesh.h"

namespace tessera {

// Whether this build has meshoptimizer. If not, Decimate leaves the mesh as it is.
bool DecimationAvailable();
inline constexpr const char* kDecimationUnavailable =
    "not in this build: install libmeshoptimizer-dev and build again";

// Removes triangles while the surface moves by no more than about a bound, by the quadrics'
// measure, and more than `share` of the triangles are left. The bound is error_m or, where that is
// more, half of the vertices' standard deviation sigmas_m (one per vertex), in steps of a factor of
// two. The vertices that stay keep their place and properties. Returns the largest error reached,
// metres. Thread-safe.
double Decimate(TriangleMesh& mesh, const std::vector<float>& sigmas_m, double error_m,
                double share);

// Removes triangles until `share` of them is left, or as many as the surface's connections need,
// whatever the error. Returns it, metres. Thread-safe.
double DecimateTo(TriangleMesh& mesh, double share);

}  // namespace tessera
