// Computes the levels of IcpModel from a predicted view, one pixel at a time. Host-device, shared
// by the CPU code and CUDA. Images are stored row by row: depth in metres, 0 where there is no
// surface; three floats of normal per pixel; intensity < 0 where there is none.
#pragma once

#include <cmath>

#include "core/scalar_ops.h"

namespace tessera {

struct ModelPixel {
    float depth_m;
    float normal[3];
    float intensity;
};

struct ModelImages {
    const float* depth_m;
    const float* normal;
    const float* intensity;
    int width, height;

    // Whether (x, y) is at a depth discontinuity: it has no depth, or a neighbour has none or
    // differs by more than jump_m. Colours are unreliable there.
    TESSERA_HD_MEMBER bool AtEdge(int x, int y, float jump_m) const {
        const float* here = depth_m + y * width + x;
        const float z = *here;
        return z <= 0 || (x > 0 && Jumps(z, here[-1], jump_m)) ||
               (x + 1 < width && Jumps(z, here[1], jump_m)) ||
               (y > 0 && Jumps(z, here[-width], jump_m)) ||
               (y + 1 < height && Jumps(z, here[width], jump_m));
    }

    // The intensity where it is reliable, else -1.
    TESSERA_HD_MEMBER float TrustedIntensity(int x, int y, float jump_m) const {
        return AtEdge(x, y, jump_m) ? -1.0f : intensity[y * width + x];
    }

    // Pixel (x, y) of an image of half the size: the mean of four pixels, if they belong to one
    // surface.
    TESSERA_HD_MEMBER ModelPixel Halved(int x, int y, float jump_m) const {
        const int first = 2 * y * width + 2 * x;
        const int at[4] = {first, first + 1, first + width, first + width + 1};
        float nearest = depth_m[first], farthest = nearest, dimmest = intensity[first];
        for (int k = 1; k < 4; ++k) {
            nearest = min(nearest, depth_m[at[k]]);
            farthest = max(farthest, depth_m[at[k]]);
            dimmest = min(dimmest, intensity[at[k]]);
        }
        if (!(nearest > 0 && farthest - nearest < jump_m)) return {0.0f, {0.0f, 0.0f, 0.0f}, -1.0f};
        ModelPixel mean{
            Sum(depth_m, at, 1, 0) / 4, {}, dimmest >= 0 ? Sum(intensity, at, 1, 0) / 4 : -1.0f};
        float* n = mean.normal;
        for (int k = 0; k < 3; ++k) n[k] = Sum(normal, at, 3, k);
        const float length2 = n[0] * n[0] + (n[1] * n[1] + n[2] * n[2]);
        const float length = length2 > 0 ? std::sqrt(length2) : 1.0f;
        for (int k = 0; k < 3; ++k) n[k] = n[k] / length;
        return mean;
    }

    TESSERA_HD_MEMBER static bool Jumps(float here, float there, float jump_m) {
        return there <= 0 || abs(there - here) > jump_m;
    }
    // The sum of one channel over four pixels.
    TESSERA_HD_MEMBER static float Sum(const float* image, const int* at, int channels,
                                       int channel) {
        const auto value = [&](int k) { return image[channels * at[k] + channel]; };
        return value(0) + value(1) + value(2) + value(3);
    }
};

}  // namespace tessera
