// Closes holes of a surface: closed loops of its border whose surroundings agree about what is
// missing.
#pragma once

#include <cstddef>

#include "core/mesh.h"
#include "finish/frame_evidence.h"

namespace tessera {

struct ClosedHoles {
    std::size_t loops = 0;  // of the border
    // Of them:
    std::size_t outer = 0;    // go round the surface's outside
    std::size_t large = 0;    // are larger than what is to be closed
    std::size_t uneven = 0;   // the surface around does not continue into the hole
    std::size_t folded = 0;   // cross themselves, as seen from the front
    std::size_t through = 0;  // frames look through
    std::size_t closed = 0;
    // Lengths: of all loops; of those that are neither outer nor large; of the closed ones.
    double border_m = 0, hole_border_m = 0, closed_border_m = 0;
    double area_m2 = 0;         // of the new surface
    std::size_t triangles = 0;  // of the new surface
};

// Closes the loops that are up to size_m across (between any two of their vertices), and appends
// the new surface behind the mesh's vertices and triangles. It is a height field over the loop's
// plane that continues the surroundings. A loop stays open if
// - it goes round the outside of a surface, or has more than 1000 edges,
// - it crosses itself as seen along the plane's normal,
// - frames look through more than a quarter of the new surface,
// - the normals on more than a tenth of it are over 60 degrees from the plane's, unless the frames
//   have measured a surface over three quarters of the new one. So a silhouette, beyond which the
//   surface goes on out of the camera's sight, is not joined with anything, and noise may be.
// New vertices get a mean of the rim's colours and the label of the nearest rim vertex. `mesh` has
// normals. Deterministic; thread-safe; uses all TBB threads.
ClosedHoles CloseHoles(TriangleMesh& mesh, double size_m, const FrameEvidence& evidence);

}  // namespace tessera
