// A source whose depth is corrected before anybody sees it.
#pragma once

#include <memory>

#include "core/depth_distortion.h"
#include "io/frame_source.h"

namespace tessera {

// Returns `source` itself if `distortion` is empty.
std::unique_ptr<FrameSource> CorrectDepth(std::unique_ptr<FrameSource> source,
                                          const DepthDistortion& distortion);

}  // namespace tessera
