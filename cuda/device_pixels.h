// Preparation of a frame's pixels on the device, with the formulas of mapping/frame_kernels.h.
// Arrays are on the device.
#pragma once

#include "core/image.h"
#include "cuda/device.h"

namespace tessera::TESSERA_DEVICE {

struct DepthGate {
    const float* raw_m;
    int width, height;
    float offset_per_m, low_m, high_m;
};

struct GatedPixels {
    // Indices of the counts, as in FrameCounts.
    enum Count { kValid, kMeasured, kPairs, kCoherent, kCounts };
    // The nearest and the farthest depth are kept in this many parts each, so that not all pixels
    // write to one place.
    static constexpr int kParts = 256;

    float* depth_m;
    float *nearest_m, *farthest_m;  // kParts of each, initialised by the caller
    double *sum_tiles, *counts;     // room for TileRoom(pixels, kCounts) and kCounts
};

void Fill(Stream& stream, float* values, int count, float value);
void GatePixels(Stream& stream, const DepthGate& gate, const GatedPixels& gated);
void MakeLuma(Stream& stream, const Rgb8* colour, int count, float* luma);
void SmoothImage(Stream& stream, const float* in, int width, int height, float* out);
void PackColours(Stream& stream, const Rgb8* colour, const float* luma, int count,
                 std::uint32_t* packed);

// Reduces every n x n pixels of images with `width` columns to one. Without intensities (null) they
// become -1.
struct Reduction {
    const float *depth_m, *intensity;
    int width, n;
};
void ReduceImages(Stream& stream, const Reduction& of, int reduced_width, int reduced_height,
                  float* intensity, float* depth_m);

// Doubles that GatedPixels::sum_tiles needs.
std::size_t GateRoom(int pixels);

}  // namespace tessera::TESSERA_DEVICE
