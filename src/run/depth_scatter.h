// How far a depth camera's measurements scatter, from its own images.
#pragma once

#include <cstdint>

#include "core/image.h"

namespace tessera {

struct DepthScatter {
    // Standard deviation of inverse depth: that of a depth is this times the depth squared.
    double sigma_per_m = 0;
    double depth_m = 0;  // the view's median
    std::int64_t samples = 0;
};

// Inverse depth is an affine function of the pixel on every plane. So what three pixels in a row
// deviate from a line is noise wherever the scene is locally flat. They are looked at along the
// image's rows and columns, at a distance at which stereo's and structured light's noise no longer
// is the same (12 of 640 columns). The largest quarter is left out (edges), and of the four
// quarters of the points by depth the one that scatters least counts: small objects only add to the
// scatter, most where they are near. `depth_m`: 0 where nothing was measured; beyond `max_depth_m`
// it does not count. Thread-safe.
DepthScatter MeasureDepthScatter(const Image<float>& depth_m, double max_depth_m);

}  // namespace tessera
