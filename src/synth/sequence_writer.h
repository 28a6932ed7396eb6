// Writes a synthetic sequence to a folder that any RGB-D system can read: TUM layout plus ground
// truth.
//
//   rgb/STAMP.png         8-bit colour
//   depth/STAMP.png       16-bit depth: 5000 = 1 m, 0 = none (also from 13.1 m on)
//   rgb.txt depth.txt     image lists
//   camera.yaml           intrinsics
//   groundtruth.txt       T_world_camera of each frame, in the scene's world frame
//   labels/STAMP.png      class of each pixel, 16 bit, 0 = surroundings
//   instances/STAMP.png   instance of each pixel, 16 bit, 0 = surroundings
//   moving/STAMP.png      only for scenes with motion: 255 = moving now, 128 = resting now,
//                         0 = static
//   classes.txt           the scene's classes
//   objects.json          its instances, with bounds and how much of each was seen
//   detections.txt        boxes as from a detector: 10 % missed, 3 % wrong, p = 0.9 +- 0.06
//   reference.ply         exact mesh of the surface with measured depth in any frame, world frame
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "synth/synthetic_source.h"

namespace tessera {

struct SequenceSummary {
    std::int64_t frames = 0;
    double path_m = 0;  // length of the camera path
    std::int64_t reference_triangles = 0;
};

// Called after each frame with the number of frames done and in total. Returning false stops
// writing; the lists and the reference mesh are then written for the frames done.
using WriteProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

// Writes all frames of the source, from the first one. Replaces an earlier sequence in the folder,
// but refuses a folder whose files of these names are not of one. Errors name the file and the
// cause (not writable, disk full); image files already written remain. `progress` may be empty.
Result<SequenceSummary> WriteSequence(SyntheticSource& source, const std::string& folder,
                                      const WriteProgress& progress);

}  // namespace tessera
