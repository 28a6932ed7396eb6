// Arguments of the ray casting kernels: the map, the camera and the output images, as plain
// pointers and numbers. Shared by the CPU's SIMD kernels and CUDA.
#pragma once

#include <cstdint>

#include "mapping/block_map_view.h"

namespace tessera {

struct RayArguments : BlockMapView {
    const ColourWord* colour;  // the map's
    // The camera. p_local [voxels from origin_block's first voxel] = voxel_from_camera * p_camera
    // [m] + start.
    float fx, fy, cx, cy;
    float voxel_from_camera[9];  // row-major
    float start[3];
    std::int32_t origin_block[3];
    float camera_from_world[9];  // rotation, row-major
    // Output images, width x height; see PredictedView for their contents.
    std::int32_t width, height;
    float* depth_m;
    float* normal_camera;  // 3 per pixel
    std::uint8_t* rgb;     // 3 per pixel
    float* intensity;
};

// Pixels [u_begin, u_end) x [v_begin, v_end), and the depth range in which to walk their rays.
struct RayTile {
    std::int32_t u_begin, u_end, v_begin, v_end;
    float first_m, last_m;
};

// Rays must end within this many blocks of the origin along each axis: 32 m at 1 mm voxels.
inline constexpr std::int32_t kRayReachBlocks = 4096;

}  // namespace tessera
