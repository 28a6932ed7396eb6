// What the ICP tracker's sums are told: the predicted view, the pose, the points and the energy, in plain pointers and
// numbers, for the CPU's vector code and CUDA alike.
#pragma once

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

}  // namespace tessera
