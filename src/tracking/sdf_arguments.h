// Arguments of the SDF tracker's sums: the map, the pose, the points and the energy, as plain
// pointers and numbers. Shared by the CPU's SIMD kernels and CUDA.
#pragma once

#include <cstdint>

#include "mapping/block_map_view.h"

namespace tessera {

struct SdfArguments : BlockMapView {
    // p_local [voxels] = rotation * p_camera [m] + translation; O is origin_block's first voxel.
    float rotation[9];
    float translation[3];
    std::int32_t origin_block[3];
    // The points in the camera frame, padded to a multiple of kPointPadding with weight 0.
    const float* x;
    const float* y;
    const float* z;
    const float* intensity;  // < 0 where there is none
    const float* weight;
    // For the chroma residuals: the points' chroma and the map's colours. `colour` null: intensity
    // only.
    const float* cb;
    const float* cr;
    const ColourWord* colour;
    // The residuals.
    bool use_intensity;
    bool normalise;  // divide distances by their gradient's length where it exceeds 1
    float gain, offset;
    float distance_scale_m, intensity_scale;  // Huber
    // If not null: receive the residuals per point, NaN where unknown, and the distances' gradients
    // in the axes of the local coordinates.
    float* distance_residual;
    float* intensity_residual;
    float* gradient[3];
};

}  // namespace tessera
