// Arguments of the prealignment's sums, for the CPU's SIMD kernels and a GPU: the last image's
// pixels as points, compared with the newest image.
#pragma once

#include "tracking/view_arguments.h"

namespace tessera {

struct AlignArguments : ViewArguments {  // z = 0: no point
    float offset;                        // newest intensity ~ last intensity + offset
    float depth_gate_m;
    float depth_scale_m, intensity_scale;  // Huber; the depth scale grows with depth beyond 1 m
};

}  // namespace tessera
