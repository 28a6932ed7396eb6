// Arguments of the fusion kernels: map layers, frame, camera and weights, as plain pointers and
// numbers. Shared by the CPU's SIMD kernels and CUDA.
#pragma once

#include <cstdint>

#include "mapping/truncation_band.h"
#include "mapping/voxel.h"

namespace tessera {

enum class DistanceWeight {
    kConstant,    // 1                                  [D18] eq. 7
    kLinearExp,   // 1, falling off behind the surface  [B14] eq. 13
    kDepthNoise,  // (1 m / z)^2: structured light's depth noise grows with z^2
};

enum class ColourWeighting {
    kCosine,  // cos(theta) * w(d)    [B14] eq. 17
    kSame,    // w(d)                 [D18] eq. 6
};

// p_camera = rotation * (voxel index - origin) * voxel_size_m + translation; rotation is row-major.
struct VoxelToCamera {
    float rotation[9];
    float translation[3];
};

struct FusionArguments {
    // The map's layers.
    FieldWord* field;
    std::uint16_t* weight;
    ColourWord* colour;
    const std::int32_t* coords;  // 4 per block: x, y, z, number
    // The frame. Depth in metres, 0 = none. See PackColour for the packed colour; null if the frame
    // has no colour.
    const float* depth_m;
    const std::uint32_t* packed_colour;
    // Map surfaces nearer than this depth have disappeared; 0 = none. Null if there are none at
    // all.
    const float* gone_m;
    std::int32_t width, height;
    float fx, fy, cx, cy;
    std::uint32_t frame;  // seeds the dither
    // Geometry: the camera at the frame's timestamp, and its motion around that time (FrameMotion).
    VoxelToCamera to_camera;
    bool moving;
    float twist_per_s[6];
    float colour_delay_s, depth_readout_s, colour_readout_s;
    std::int32_t origin[3];  // voxels
    float voxel_size_m;
    TruncationBand band;
    // Weights.
    DistanceWeight distance_weight;
    ColourWeighting colour_weighting;
    float epsilon_m, sigma;  // for kLinearExp
    float max_weight, max_colour_weight;
    float gain, offset;                       // map intensity = gain * image intensity + offset
    float frame_weight, frame_colour_weight;  // factor for the whole frame (blur), in (0, 1]
};

// Packed colour pixel: bits 0-15 Y (65535 = 1), 16-23 Cb + 128, 24-31 Cr + 128.
inline constexpr float kPackedChroma = 255.0f;

}  // namespace tessera
