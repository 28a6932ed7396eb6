// Which pixels of a box are the object: by the paper's rule, or by the object's own shape in the
// depth image.
#pragma once

#include <span>

#include "core/camera.h"
#include "core/image.h"
#include "semantics/detector.h"

namespace tessera {

// `mask` gets the box's size: 1 = object. Pixels without depth are never the object. Pure
// functions, thread-safe, the same result on every run.

// [D18] 3.3: what is deeper than the mean depth of the box is not the object.
void SegmentByMeanDepth(const DepthImage& depth_m, const PixelBox& box, Image<std::uint8_t>& mask);

// 1. What surrounds the box is mostly what carries the object or lies behind it: the planes that
// dominate a ring around
//    the box are fitted (RANSAC) and left out of it.
// 2. The rest falls into pieces connected in depth. The object is the piece that fills the box best
// and goes on least
//    outside of it, with the pieces at its depth that do not go on outside.
// 3. Nothing left: the object is flat on its support (a picture on a wall), and is the box's part
// of that plane. `others`: boxes of other objects, which are no surroundings.
void SegmentByDepth(const DepthImage& depth_m, const PinholeCamera& camera, const PixelBox& box,
                    std::span<const PixelBox> others, Image<std::uint8_t>& mask);

}  // namespace tessera
