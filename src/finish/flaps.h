// Takes off what the scan has added to the surface: flaps behind edges and in front of them, which
// frames look through, and the fringe along the border.
#pragma once

#include <cstddef>

#include "core/mesh.h"
#include "finish/frame_evidence.h"

namespace tessera {

struct RemovedFlaps {
    std::size_t triangles = 0;  // that frames look through
    std::size_t fringe = 0;     // triangles that hung on one edge
    double area_m2 = 0;         // of both
};

// Removes each triangle most of whose corners more frames look through than measure, then those
// that hang on the rest by one edge or none, again and again: strips of a triangle's width and
// spikes. So what has moved on, or was a mean of a near and a far surface, goes. Vertices that are
// left over go, too. Thread-safe; uses all TBB threads.
RemovedFlaps RemoveFlaps(TriangleMesh& mesh, const FrameEvidence& evidence);

}  // namespace tessera
