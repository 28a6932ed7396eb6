// The hot loop of the ICP tracker behind plain pointers: projective association with the predicted view and the normal
// equations, over a run of points. Compiled twice (portable, AVX2); icp_tracker.cpp picks. No Eigen here.
//
// Which points have partners changes with the pose. So that a step can be judged, energies are summed over the residuals
// that exist at both poses.
#pragma once

#include "tracking/icp_kernels.h"
#include "tracking/normal_equations.h"

namespace tessera {

struct IcpArguments {
    // The predicted view, row by row, and its camera, in whose frame the pose is sought.
    int width, height;
    float fx, fy, cx, cy;
    const float* depth;      // metres along z, 0 where nothing is
    const float* normal;     // three a pixel, unit
    const float* intensity;  // < 0 where there is none or where the depth jumps
    // p_view [m] = rotation * p_camera [m] + translation.
    float rotation[9];
    float translation[3];
    // The points in the camera frame, metres, padded to a multiple of kPointPadding with weight 0.
    const float* x;
    const float* y;
    const float* z;
    const float* normal_x;
    const float* normal_y;
    const float* normal_z;
    const float* intensity_of_point;  // < 0 where there is none
    const float* weight;
    // The energy.
    float distance_gate_m, normal_gate_cosine;
    float distance_scale_m, intensity_scale;  // Huber
    float intensity_gate;
    float alpha;
    float gain, offset;
    float inlier_distance_m;  // for SumLayout::kInliers
    // Residuals per point, NaN where there is none: those here, and (null at first) those at the pose before.
    float* distance_residual;
    float* intensity_residual;
    const float* distance_before;
    const float* intensity_before;
};

// Adds the sums (SumLayout) over points [first, last), both multiples of kPointPadding, to sums[].
namespace baseline {
void SumIcpPoints(const IcpArguments& arguments, int first, int last, double* sums);
}
namespace avx2 {
void SumIcpPoints(const IcpArguments& arguments, int first, int last, double* sums);
}

}  // namespace tessera
