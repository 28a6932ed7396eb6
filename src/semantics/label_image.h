// Detections as an image: which object each pixel shows ([D18] 3.3, figure 7b).
#pragma once

#include <span>

#include "core/camera.h"
#include "semantics/detector.h"

namespace tessera {

struct LabelImage {
    // 0: nothing is said. Else the number of the detection, counted from 1, or kBesideObjects: in
    // some box, but not of its object.
    static constexpr std::uint8_t kBesideObjects = 255;
    static constexpr std::size_t kMostDetections = 254;  // the most probable ones are taken
    Image<std::uint8_t> detection;
    // Of a pixel that two detections claim, the number of the larger one; else 0.
    Image<std::uint8_t> second;
};

// Where boxes overlap, the smaller one's object is before or upon the larger one's. Of two classes
// given to nearly the same box the more probable one counts. `detections` as KeepWanted sorts them,
// boxes in pixels of the depth image. Uses all cores (TBB).
void MakeLabelImage(const DepthImage& depth_m, const PinholeCamera& camera,
                    std::span<const Detection> detections, LabelRegion region, LabelImage& labels);

}  // namespace tessera
