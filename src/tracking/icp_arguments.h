// What the ICP tracker's sums are told: the predicted view, the pose, the points and the energy, in
// plain pointers and numbers, for the CPU's vector code and CUDA alike.
#pragma once

#include "tracking/view_arguments.h"

namespace tessera {

struct IcpArguments : ViewArguments {  // the image is the predicted view
    const float* normal;               // three a pixel, unit
    // Of the points; weight 0: no point.
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
    float inlier_distance_m;  // for SumLayout::kInliers
    // Residuals per point, NaN where there is none: those here, and (null at first) those at the
    // pose before.
    float* distance_residual;
    float* intensity_residual;
    float* gradient[3];  // of the distances: the partner's normal
    const float* distance_before;
    const float* intensity_before;
};

}  // namespace tessera
