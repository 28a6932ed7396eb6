// Draws detections into an image: which object each pixel shows ([D18] 3.3, figure 7b).
#pragma once

#include <span>

#include "core/camera.h"
#include "semantics/detector.h"

namespace tessera {

struct LabelImage {
    // 0: no information. Otherwise the number of the detection, counted from 1, or kBesideObjects:
    // inside some box, but not part of its object.
    static constexpr std::uint8_t kBesideObjects = 255;
    static constexpr std::size_t kMostDetections = 254;  // only the most probable ones are used
    Image<std::uint8_t> detection;
    // If two detections claim a pixel, the number of the larger one; otherwise 0.
    Image<std::uint8_t> second;
};

// Where boxes overlap, the smaller object is in front of the larger one or on it. If two classes
// share nearly the same box, the more probable one counts. `detections`: as sorted by FilterWanted,
// boxes in pixels of the depth image. Uses all cores (TBB).
void MakeLabelImage(const DepthImage& depth_m, const PinholeCamera& camera,
                    std::span<const Detection> detections, LabelRegion region, LabelImage& labels);

}  // namespace tessera
