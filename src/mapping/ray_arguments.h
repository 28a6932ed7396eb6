// What the ray caster's kernels are told: the map, the camera and the images to write, in plain
// pointers and numbers, for the CPU's vector code and CUDA alike.
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
    // The images to write, width x height; PredictedView says what they hold.
    std::int32_t width, height;
    float* depth_m;
    float* normal_camera;  // 3 a pixel
    std::uint8_t* rgb;     // 3 a pixel
    float* intensity;
};

// Pixels [u_begin, u_end) x [v_begin, v_end), and the depths between which their rays are walked.
struct RayTile {
    std::int32_t u_begin, u_end, v_begin, v_end;
    float first_m, last_m;
};

// Rays must end within so many blocks of the origin along each axis: at 1 mm voxels 32 m.
inline constexpr std::int32_t kRayReachBlocks = 4096;

}  // namespace tessera
