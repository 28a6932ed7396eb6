// From a scanned mesh and the frames that it was made from to a finished model: cleaned, holes
// closed, with fewer triangles, and with a texture as sharp as the camera's images.
#pragma once

#include <functional>
#include <vector>

#include "core/frame.h"
#include "finish/clean_surface.h"
#include "finish/textured_level.h"

namespace tessera {

struct FinishOptions {
    CleanOptions clean;
    LevelOptions texture;
    // Of detail, at most: each has a quarter of the triangles, and texels twice as wide. They end
    // before one with fewer than four triangles.
    int lower_levels = 0;
};

struct FinishedModel {
    TexturedMesh model;
    std::vector<TexturedMesh> lower_levels;
    TriangleMesh surface;  // the model's, not cut into charts, with the mesh's colours
    TriangleMesh filled;   // the surface that closes holes, by itself, before triangles are removed
    FinishReport report;
};

// Reads the next frame, with T_world_camera in the mesh's world, or without where the frame has no
// pose or no colour. False at the end.
using NextPosedFrame = std::function<bool(Frame&)>;
// Told after each step what is done, as a share of all; false cancels.
using FinishProgress = std::function<bool(const char* step, double share)>;

struct FinishFrames {
    // Up to FrameEvidence::kMostFrames of all, spread evenly; read before any of `at`. They tell
    // what they look through. May be null: then nothing is known about that.
    NextPosedFrame sample;
    // Reads the frames at these time stamps, which increase, and possibly others between them.
    std::function<NextPosedFrame(const std::vector<double>& stamps_s)> at;
    std::int64_t count = 0;  // of all, about
    // What the source's rows took to be read; 0: at one time.
    double depth_readout_s = 0, colour_readout_s = 0;
};

// `path`: where the camera was, in the mesh's world, by increasing time. `mesh` has normals; where
// it has colours, the texture's exposure is theirs. Errors: an empty mesh, one without normals, too
// many pieces for a texture, cancelled.
Result<FinishedModel> FinishModel(TriangleMesh mesh, const PinholeCamera& camera,
                                  std::span<const StampedPose> path, const FinishFrames& frames,
                                  const FinishOptions& options, const FinishProgress& progress);

}  // namespace tessera
