// What the SDF tracker's sums are told: the map, the pose, the points and the energy, in plain pointers and numbers,
// for the CPU's vector code and CUDA alike.
#pragma once

#include <cstdint>

namespace tessera {

struct SdfArguments {
    // The map (BlockMap::View).
    const std::uint32_t* field;
    const std::int32_t* neighbours;
    const std::int32_t* table;
    const std::int32_t* coords;
    std::uint32_t table_mask;
    float voxel_size_m, truncation_m;
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
    // The energy.
    float alpha;
    bool normalise;  // divide distances by their gradient's length where it exceeds 1
    float gain, offset;
    float distance_scale_m, intensity_scale;  // Huber
    float inlier_distance_m;  // for SumLayout::kInliers
    // If not null: residuals per point, NaN where unknown.
    float* distance_residual;
    float* intensity_residual;
};

}  // namespace tessera
