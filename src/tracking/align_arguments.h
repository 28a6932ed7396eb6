// What the prealignment's sums are told, for the CPU's vector code and a GPU alike: the last
// image's pixels as points, held against the newest image.
#pragma once

#include "tracking/view_arguments.h"

namespace tessera {

struct AlignArguments : ViewArguments {  // z = 0: no point
    float offset;                        // newest intensity ~ last intensity + offset
    float depth_gate_m;
    float depth_scale_m, intensity_scale;  // Huber; the depth's grows with the distance beyond 1 m
};

}  // namespace tessera
