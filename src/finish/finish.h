// From a scanned mesh and the frames that it was made from to a finished model: without islands,
// with fewer triangles, and with a texture as sharp as the camera's images.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/se3.h"
#include "finish/islands.h"
#include "io/textured_mesh.h"

namespace tessera {

struct FinishOptions {
    double least_island_m2 = 0.01;  // smaller pieces are removed; 0 keeps all
    // Rounds of smoothing where the depth's standard deviation is 2 mm (1 m from the camera); as
    // the square of it elsewhere, up to 20 times as many. 0: the surface stays as it was fused.
    int smoothing_rounds = 5;
    // Triangles are removed while the surface moves by no more than about this, metres, or half of
    // the depth's standard deviation, and more than this share of them is left. 0 and 1 keep all.
    double decimation_error_m = 0.001, decimation_share = 0.1;
    double texel_m = 0.002;   // on the surface; made larger until the texture fits
    int texture_side = 4096;  // texels
};

struct FinishReport {
    std::size_t triangles_before = 0;
    RemovedIslands islands;
    double decimation_error_m = 0;  // reached
    std::size_t charts = 0;
    double texel_m = 0;       // reached
    std::int64_t frames = 0;  // read
    std::int64_t views = 0;   // of them, that the texture was made from
    double seen_share = 0;    // of the texels
};

struct FinishedModel {
    TexturedMesh model;
    FinishReport report;
};

// Reads the next frame, with T_world_camera in the mesh's world, or without where the frame has no
// pose or no colour. False at the end.
using NextPosedFrame = std::function<bool(Frame&)>;
// Told after each step what is done, as a share of all; false cancels.
using FinishProgress = std::function<bool(const char* step, double share)>;

// `path`: where the camera was, in the mesh's world. `mesh` has normals; where it has colours, the
// texture's exposure is theirs. `frames` is how many frames there are, about. Errors: an empty
// mesh, one without normals, too many pieces for a texture, cancelled.
Result<FinishedModel> FinishModel(TriangleMesh mesh, const PinholeCamera& camera,
                                  std::span<const StampedPose> path, const NextPosedFrame& next,
                                  std::int64_t frames, const FinishOptions& options,
                                  const FinishProgress& progress);

}  // namespace tessera
