// A synthetic sequence as a folder that any RGB-D system reads: TUM layout plus exact truth.
//
//   rgb/STAMP.png         8-bit colour
//   depth/STAMP.png       16-bit depth: 5000 = 1 m, 0 = none (so is 13.1 m and more)
//   rgb.txt depth.txt     image lists
//   camera.yaml           intrinsics
//   groundtruth.txt       T_world_camera of each frame, in the scene's world
//   labels/STAMP.png      class of each pixel, 16 bit, 0 = surroundings
//   instances/STAMP.png   instance of each pixel, likewise
//   moving/STAMP.png      only of scenes in which something moves: 255 = moves now, 128 = rests
//   now,
//                         0 = static
//   classes.txt           the scene's classes
//   objects.json          its instances, with bounds and how much of them was seen
//   detections.txt        boxes as a detector would give them: 10 % missed, 3 % wrong,
//                         p = 0.9 +- 0.06
//   reference.ply         exact mesh of what has measured depth in some frame, in the scene's world
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "synth/synthetic_source.h"

namespace tessera {

struct SequenceSummary {
    std::int64_t frames = 0;
    double path_m = 0;  // length of the camera's way
    std::int64_t reference_triangles = 0;
};

// Called after each frame with the frames done and their total; false stops the writing after it,
// and the folder is completed with what there is.
using WriteProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

// Writes all frames of the source from its first on. Errors name the file and what failed (not
// writable, disk full); image files written before stay. `progress` may be empty.
Result<SequenceSummary> WriteSequence(SyntheticSource& source, const std::string& folder,
                                      const WriteProgress& progress);

}  // namespace tessera
