// What intensity residuals have in common over a part of the image is no motion: it is vignetting,
// exposure, and light that falls or is reflected in another way than when the map was coloured. It
// is added to the intensities of the points, which leaves their texture to tracking. Host-device,
// shared by the CPU code and CUDA; in float.
#pragma once

#include <cmath>

#include "core/scalar_ops.h"
#include "tracking/residual_kernels.h"

namespace tessera {

struct ShadingArguments {
    int width, height;      // of the points, as in FramePoints
    const float* residual;  // the map's intensity less the image's; NaN where unknown
    float* intensity;       // of the points; -1 where unknown
    float gain;             // of the frame
    float limit;            // larger residuals count as this
    // Of the patches: sums and numbers of residuals, and weighted means over 3 x 3 patches.
    float *sum, *count, *mean;

    TESSERA_HD_MEMBER int Patch() const { return PatchSide(width); }
    TESSERA_HD_MEMBER int Columns() const { return (width + Patch() - 1) / Patch(); }
    TESSERA_HD_MEMBER int Rows() const { return (height + Patch() - 1) / Patch(); }
    TESSERA_HD_MEMBER int Patches() const { return Columns() * Rows(); }
    TESSERA_HD_MEMBER int Spans() const { return Columns() * height; }
};

struct ShadingKernels {
    TESSERA_HD_MEMBER static int Lower(int a, int b) { return a < b ? a : b; }

    // Three loops, one after the other: over patches, over patches, over Spans().
    TESSERA_HD_MEMBER static void SumPatch(const ShadingArguments& a, int patch) {
        const int x0 = patch % a.Columns() * a.Patch(), y0 = patch / a.Columns() * a.Patch();
        const int x1 = Lower(x0 + a.Patch(), a.width), y1 = Lower(y0 + a.Patch(), a.height);
        float sum = 0, count = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const float r = a.residual[y * a.width + x];
                if (std::isnan(r)) continue;
                sum += max(-a.limit, min(r, a.limit));
                count += 1;
            }
        a.sum[patch] = sum;
        a.count[patch] = count;
    }

    // Weights 1, 2, 1 in both directions: equal ones have negative frequencies, which grow if
    // shading is removed again and again.
    TESSERA_HD_MEMBER static void MeanAround(const ShadingArguments& a, int patch) {
        const int column = patch % a.Columns(), row = patch / a.Columns();
        float sum = 0, count = 0;
        for (int y = row > 0 ? row - 1 : 0; y <= Lower(row + 1, a.Rows() - 1); ++y)
            for (int x = column > 0 ? column - 1 : 0; x <= Lower(column + 1, a.Columns() - 1);
                 ++x) {
                const float weight = (y == row ? 2.0f : 1.0f) * (x == column ? 2.0f : 1.0f);
                sum += weight * a.sum[y * a.Columns() + x];
                count += weight * a.count[y * a.Columns() + x];
            }
        a.mean[patch] = count > 0 ? sum / count : 0.0f;
    }

    // To a patch's points in one row. `span`: row * Columns() + column of the patch.
    TESSERA_HD_MEMBER static void AddShading(const ShadingArguments& a, int span) {
        const int row = span / a.Columns(), column = span % a.Columns();
        const float shading = a.mean[row / a.Patch() * a.Columns() + column] / a.gain;
        const int first = row * a.width + column * a.Patch();
        const int last = row * a.width + Lower((column + 1) * a.Patch(), a.width);
        for (int i = first; i < last; ++i)  // not below 0, which would mean "unknown"
            if (a.intensity[i] >= 0) a.intensity[i] = max(0.0f, a.intensity[i] + shading);
    }
};

}  // namespace tessera
