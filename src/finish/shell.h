// A closed body of a scanned surface, for 3D printers and volumes.
#pragma once

#include <cstddef>

#include "core/mesh.h"

namespace tessera {

struct Shell {
    TriangleMesh mesh;
    std::size_t closed_pieces = 0;  // were closed surfaces before: solid
    std::size_t open_pieces = 0;    // have been given a back and sides
};

// A scan shows one side of most things, so its surface has a border, and nothing says how deep what
// is behind it is. Each piece that has a border becomes a plate: a back `thickness_m` behind it,
// along the normals, and sides along the border. Pieces without a border stay as they are. Every
// edge of the result has as many triangles on one side as on the other, two in all but for edges
// that lie in one another; what does not fit together so (three triangles on an edge, pieces that
// meet in a vertex, neighbours that disagree about inside and outside) is taken apart first. Where
// the surface is curved more tightly than the thickness, the back may cross the front; programs
// that print take the union. Degenerate triangles are dropped. Colours are kept, labels are not.
// Takes time in proportion to the mesh. Thread-safe.
Shell MakeShell(const TriangleMesh& mesh, double thickness_m);

}  // namespace tessera
