// Arguments of the ICP tracker's sums: the predicted view, the pose, the points and the energy, as
// plain pointers and numbers. Shared by the CPU's SIMD kernels and CUDA.
#pragma once

#include "mapping/truncation_band.h"
#include "tracking/view_arguments.h"

namespace tessera {

struct IcpArguments : ViewArguments {  // the image is the predicted view
    const float* normal;               // three per pixel, unit
    // The points; weight 0: no point.
    const float* normal_x;
    const float* normal_y;
    const float* normal_z;
    const float* weight;
    // The energy.
    float distance_gate_m, normal_gate_cosine;
    float distance_scale_m, intensity_scale;  // Huber
    float intensity_gate;
    float alpha;
    float gain, offset;
    TruncationBand band;  // of the map
    // Residuals per point, NaN where there is none: at this pose, and at the previous one (null at
    // first).
    float* distance_residual;
    float* intensity_residual;
    float* gradient[3];  // of the distances: the associated pixel's normal
    const float* distance_before;
    const float* intensity_before;
};

}  // namespace tessera
