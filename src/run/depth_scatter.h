// How far a depth camera's measurements scatter, from its own images.
#pragma once

#include <cstdint>

#include "core/image.h"

namespace tessera {

struct DepthScatter {
    double sigma_m = 0;  // standard deviation of a measurement, at the view's median depth
    double depth_m = 0;  // that depth
    std::int64_t samples = 0;
};

// Inverse depth is an affine function of the pixel on every plane. So what three pixels in a row
// deviate from a line is noise wherever the scene is locally flat: the median over the image's rows
// and columns, at a distance at which stereo's and structured light's noise no longer is the same
// (12 of 640 columns). Edges and texture are tails that the median leaves out; a scene of small
// objects only adds to it. `depth_m`: 0 where nothing was measured; beyond `max_depth_m` it does
// not count. Thread-safe.
DepthScatter MeasureDepthScatter(const Image<float>& depth_m, double max_depth_m);

}  // namespace tessera
