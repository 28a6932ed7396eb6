// From a scanned surface to one without islands, flaps and small holes, smooth and with few
// triangles.
#pragma once

#include <span>

#include "core/camera.h"
#include "core/se3.h"
#include "finish/finish_report.h"
#include "finish/frame_evidence.h"

namespace tessera {

struct CleanOptions {
    double least_island_m2 = 0.01;  // smaller pieces are removed; 0 keeps all
    bool remove_flaps = true;       // what frames look through, and the fringe
    // Rounds of smoothing where the depth's standard deviation is 2 mm (1 m from the camera); as
    // the square of it elsewhere, up to 20 times as many. 0: the surface stays as it was fused.
    int smoothing_rounds = 5;
    // Holes up to this size are closed, metres; 0 closes none. An island in a hole of 0.1 m is
    // smaller than least_island_m2, so nothing is left in such a hole that the new surface could
    // lie over.
    double hole_m = 0.1;
    // Triangles are removed while the surface moves by no more than about this, metres, or half of
    // the depth's standard deviation, and more than this share of them is left. 0 and 1 keep all.
    double decimation_error_m = 0.001, decimation_share = 0.1;
};

struct CleanSurface {
    TriangleMesh mesh;             // cleaned, holes closed
    std::vector<float> sigmas_m;   // per vertex: of the depth from which it was measured
    std::size_t first_filled = 0;  // triangles from here on close holes
};

// All but the decimation. `path`: where the camera was. `mesh` has normals and colours. Fills its
// parts of the report. Thread-safe; uses all TBB threads.
CleanSurface Clean(TriangleMesh mesh, const PinholeCamera& camera,
                   std::span<const StampedPose> path, const FrameEvidence& evidence,
                   const CleanOptions& options, FinishReport& report);

// The surface that closes holes, by itself.
TriangleMesh FilledPart(const CleanSurface& surface);

}  // namespace tessera
