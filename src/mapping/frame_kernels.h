// Prepares a frame's pixels for tracking and fusion: corrects and gates depth, converts colour to
// luma and chroma, and smooths luma. Host-device, shared by the CPU code and CUDA.
#pragma once

#include <cstdint>

#include "core/host_device.h"
#include "core/image.h"
#include "core/scalar_ops.h"

namespace tessera {

// See PreparedFrame::Config::disparity_offset_per_m.
TESSERA_HD float CorrectedDepth(float z_m, float offset_per_m) {
    return z_m / (1.0f + offset_per_m * z_m);
}

// False for NaN.
TESSERA_HD bool InRange(float z_m, float low_m, float high_m) {
    return z_m >= low_m && z_m <= high_m;
}

// Whether two adjacent depths are within 5 %.
TESSERA_HD bool Coherent(float left_m, float right_m) {
    return abs(left_m - right_m) < 0.05f * left_m;
}

// ITU-R BT.601 luma with the weights of [B14] eq. 7, in [0, 255].
TESSERA_HD float Luma255(const Rgb8& colour) {
    return 0.299f * colour.r + 0.587f * colour.g + 0.114f * colour.b;
}

// Packs a pixel for FusionArguments::packed_colour. `luma` is in [0, 1], smoothed or not.
TESSERA_HD std::uint32_t PackColour(const Rgb8& colour, float luma) {
    const float y = Luma255(colour);
    const float cb = (colour.b - y) * (1.0f / 1.772f);
    const float cr = (colour.r - y) * (1.0f / 1.402f);
    // Pure blue and pure red would give 256.
    return static_cast<std::uint32_t>(luma * 65535.0f + 0.5f) |
           static_cast<std::uint32_t>(min(cb + 128.5f, 255.0f)) << 16 |
           static_cast<std::uint32_t>(min(cr + 128.5f, 255.0f)) << 24;
}

// Three image rows around the row to smooth. At the image border, the border row is repeated.
struct RowsAround {
    const float *above, *here, *below;

    // The rows around row y of `image`.
    TESSERA_HD_MEMBER static RowsAround Of(const float* image, int width, int height, int y) {
        const float* here = image + static_cast<std::int64_t>(y) * width;
        return {y > 0 ? here - width : here, here, y + 1 < height ? here + width : here};
    }
    TESSERA_HD_MEMBER float Column(int x) const { return above[x] + 2.0f * here[x] + below[x]; }
};

// Mean of the n x n pixels whose first pixel is (x n, y n).
TESSERA_HD float MeanOfTile(const float* image, int width, int n, int x, int y) {
    float sum = 0;
    for (int v = y * n; v < (y + 1) * n; ++v)
        for (int u = x * n; u < (x + 1) * n; ++u)
            sum += image[static_cast<std::int64_t>(v) * width + u];
    return sum / static_cast<float>(n * n);
}

// Binomial 1-2-1 filter in both directions. Not for the first and last columns.
TESSERA_HD float SmoothInside(const RowsAround& rows, int x) {
    return (rows.Column(x - 1) + 2.0f * rows.Column(x) + rows.Column(x + 1)) * (1.0f / 16.0f);
}

// The same for every column; repeats the border.
TESSERA_HD float SmoothAt(const RowsAround& rows, int x, int width) {
    if (x == 0) return (3.0f * rows.Column(0) + rows.Column(1)) * (1.0f / 16.0f);
    if (x == width - 1)
        return (rows.Column(width - 2) + 3.0f * rows.Column(width - 1)) * (1.0f / 16.0f);
    return SmoothInside(rows, x);
}

}  // namespace tessera
