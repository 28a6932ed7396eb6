// Decides which pixels of a detection box belong to the object: by the paper's rule, or by
// connected segments of the depth image.
#pragma once

#include <span>

#include "core/camera.h"
#include "core/image.h"
#include "semantics/detector.h"

namespace tessera {

// `mask` is resized to the box; 1 = object. Pixels without depth never belong to the object. Pure
// functions, thread-safe, deterministic.

// [D18] 3.3: pixels deeper than the mean depth of the box do not belong to the object.
void SegmentByMeanDepth(const DepthImage& depth_m, const PixelBox& box, Image<std::uint8_t>& mask);

// 1. Most of what surrounds the box supports the object or lies behind it. RANSAC fits the planes
//    that dominate a ring around the box, and their pixels are removed.
// 2. The remaining pixels form pieces that are connected in depth. The object is the piece that
//    fills the box best and extends least outside of it, plus the pieces at its depth that stay
//    inside.
// 3. If nothing remains, the object lies flat on its support (a picture on a wall): all pixels of
//    the box with depth belong to it.
// `others`: boxes of other objects. The ring leaves them out.
void SegmentByDepth(const DepthImage& depth_m, const PinholeCamera& camera, const PixelBox& box,
                    std::span<const PixelBox> others, Image<std::uint8_t>& mask);

}  // namespace tessera
