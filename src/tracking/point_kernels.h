// What FramePoints computes for a pixel: its point at the frame's timestamp, weight, normal, and
// the intensity that the colour camera saw there. Host-device, shared by the CPU code and CUDA.
// Camera frame, metres.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/row_time.h"
#include "core/scalar_ops.h"
#include "mapping/fusion_arguments.h"

namespace tessera {

struct CameraPoint {
    float x, y, z;
};

// x / z (or y / z) of the ray through a pixel's column (or row), [B14] eq. 1.
TESSERA_HD float RaySlope(int pixel, double centre_px, double focal_px) {
    return static_cast<float>((pixel - centre_px) / focal_px);
}

// Transforms a point from the camera frame time_s after the frame's timestamp to the camera frame
// at the timestamp, to first order: p + time (omega x p + velocity). Use -time_s for the inverse.
// `twist_per_s`: (rotation, translation) of FrameMotion.
TESSERA_HD CameraPoint Moved(const CameraPoint& p, const float* twist_per_s, float time_s) {
    const float* w = twist_per_s;
    return {p.x + time_s * (w[1] * p.z - w[2] * p.y + w[3]),
            p.y + time_s * (w[2] * p.x - w[0] * p.z + w[4]),
            p.z + time_s * (w[0] * p.y - w[1] * p.x + w[5])};
}

constexpr double kMinWeightDepth_m = 0.5;  // default

// The inverse variance of a point's distance, up to a factor, in metres: an error of direction
// grows with the depth, that of disparity with its square; at noise_depth_m they are equal. Points
// nearer than nearest_m have its weight. With noise_depth_m = 0 all weigh the same.
TESSERA_HD float PointWeight(float z_m, float noise_depth_m, float nearest_m) {
    if (noise_depth_m <= 0) return 1.0f;
    const float z = max(z_m, nearest_m), r = z / noise_depth_m;
    return 1.0f / (z * z * (1.0f + r * r));
}

// Whether three measured depths in a row may belong to one surface.
TESSERA_HD bool OneSurface(float before, float here, float after) {
    constexpr float kBend = 0.03f;  // fraction of the depth
    return before > 0 && after > 0 && abs(before + after - 2 * here) < kBend * here;
}

// A depth or intensity image, row by row, and its camera.
struct PinholeImage {
    const float* pixels;
    int width, height;
    float fx, fy, cx, cy;

    TESSERA_HD_MEMBER float At(int u, int v) const { return pixels[v * width + u]; }
    TESSERA_HD_MEMBER CameraPoint PointAt(int u, int v) const {
        const float d = At(u, v);
        return {(static_cast<float>(u) - cx) / fx * d, (static_cast<float>(v) - cy) / fy * d, d};
    }
    // Bilinear; -1 outside.
    TESSERA_HD_MEMBER float Between(float u, float v) const {
        if (!(u >= 0 && v >= 0 && u < static_cast<float>(width - 1) &&
              v < static_cast<float>(height - 1)))
            return -1.0f;
        const int x = static_cast<int>(u), y = static_cast<int>(v);
        const float fu = u - static_cast<float>(x), fv = v - static_cast<float>(y);
        const float* above = pixels + y * width + x;
        const float* below = above + width;
        const float top = above[0] + fu * (above[1] - above[0]);
        const float bottom = below[0] + fu * (below[1] - below[0]);
        return top + fv * (bottom - top);
    }
};

// The normal of the depth image's surface at (u, v): unit, towards the camera, from differences
// across radius_px pixels to each side; with radius 0 from the differences to the next pixel ([D18]
// eq. 15). Returns false if there is none: at a depth discontinuity or beside a hole.
TESSERA_HD bool NormalAt(const PinholeImage& depth, int u, int v, int radius_px,
                         CameraPoint& normal) {
    const int left = u > radius_px ? u - radius_px : 0, up = v > radius_px ? v - radius_px : 0;
    const int ahead = radius_px > 0 ? radius_px : 1;
    const int right = u + ahead < depth.width ? u + ahead : depth.width - 1;
    const int down = v + ahead < depth.height ? v + ahead : depth.height - 1;
    const float d = depth.At(u, v);
    if (!OneSurface(depth.At(left, v), d, depth.At(right, v)) ||
        !OneSurface(depth.At(u, up), d, depth.At(u, down)))
        return false;
    const CameraPoint low = depth.PointAt(u, down), high = depth.PointAt(u, up);
    const CameraPoint east = depth.PointAt(right, v), west = depth.PointAt(left, v);
    const CameraPoint a{low.x - high.x, low.y - high.y, low.z - high.z};
    const CameraPoint b{east.x - west.x, east.y - west.y, east.z - west.z};
    const CameraPoint n{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const float length2 = n.x * n.x + (n.y * n.y + n.z * n.z);
    const float length = length2 > 0 ? std::sqrt(length2) : 1.0f;
    normal = {n.x / length, n.y / length, n.z / length};
    return true;
}

// The image's value at a point's projection; -1 if there is none.
TESSERA_HD float SampleAtPoint(const PinholeImage& image, const CameraPoint& p) {
    if (!(p.z > 0.05f)) return -1.0f;
    return image.Between(p.x / p.z * image.fx + image.cx, p.y / p.z * image.fy + image.cy);
}

// Which points of a frame: those of every `step`-th pixel in both directions, in slots row by row.
struct PointArguments {
    PinholeImage depth;      // metres, 0 = none
    PinholeImage intensity;  // same size; `pixels` null: not to be read
    // Whether the points need chroma too, and the same pixels as PackColour packs them.
    bool chroma;
    const std::uint32_t* packed_colour;
    double fx, fy, cx, cy;  // of the same camera, for RaySlope
    int step;
    int width, height;               // slots per row (some lie right of the image), and rows
    float noise_depth_m, nearest_m;  // for PointWeight
    int normal_radius_px;            // for NormalAt; negative: no normals
    float twist_per_s[6];            // from FrameMotion, as are the times below
    bool still;                      // the twist is zero
    double depth_readout_s, colour_delay_s, colour_readout_s;
};

// Values shared by the points of one row.
struct PointRow {
    int v;  // row of the image
    float slope_y;
    float depth_time_s, colour_time_s;
};
TESSERA_HD PointRow RowOfPoints(const PointArguments& a, int row) {
    const int v = row * a.step + a.step / 2;
    return {v, RaySlope(v, a.cy, a.fy),
            static_cast<float>(RowTime(a.depth_readout_s, v, a.depth.height)),
            static_cast<float>(a.colour_delay_s + RowTime(a.colour_readout_s, v, a.depth.height))};
}

// The point that the pixel in column u measured at this depth, at the frame's timestamp.
TESSERA_HD CameraPoint PointOfPixel(const PointArguments& a, const PointRow& row, int u,
                                    float depth_m) {
    return Moved({RaySlope(u, a.cx, a.fx) * depth_m, row.slope_y * depth_m, depth_m}, a.twist_per_s,
                 row.depth_time_s);
}

// The chroma of a packed colour pixel, in the units of voxel.h: Cb = (B - Y) / 1.772, Cr = (R - Y)
// / 1.402.
struct Chroma {
    float cb, cr;
};
TESSERA_HD Chroma ChromaOfPacked(std::uint32_t pixel) {
    return {static_cast<float>(static_cast<int>(pixel >> 16 & 255u) - 128) * (1.0f / kPackedChroma),
            static_cast<float>(static_cast<int>(pixel >> 24) - 128) * (1.0f / kPackedChroma)};
}

// The intensity that the colour camera saw at this point, at its own time; -1: none.
TESSERA_HD float IntensityOfPoint(const PointArguments& a, const PointRow& row, int u,
                                  const CameraPoint& p) {
    return a.still ? a.intensity.At(u, row.v)
                   : SampleAtPoint(a.intensity, Moved(p, a.twist_per_s, -row.colour_time_s));
}

// The chroma there. Requires that the point has an intensity.
TESSERA_HD Chroma ChromaOfPoint(const PointArguments& a, const PointRow& row, int u,
                                const CameraPoint& p) {
    const std::uint32_t* const pixels = a.packed_colour;
    const int width = a.intensity.width;
    if (a.still) return ChromaOfPacked(pixels[row.v * width + u]);
    const CameraPoint q = Moved(p, a.twist_per_s, -row.colour_time_s);
    const float column = q.x / q.z * a.intensity.fx + a.intensity.cx;
    const float line = q.y / q.z * a.intensity.fy + a.intensity.cy;
    const int x = static_cast<int>(column), y = static_cast<int>(line);
    const float fu = column - static_cast<float>(x), fv = line - static_cast<float>(y);
    const std::uint32_t* const first = pixels + y * width + x;
    const Chroma c00 = ChromaOfPacked(first[0]), c10 = ChromaOfPacked(first[1]);
    const Chroma c01 = ChromaOfPacked(first[width]), c11 = ChromaOfPacked(first[width + 1]);
    const auto between = [fu, fv](float v00, float v10, float v01, float v11) {
        const float top = v00 + fu * (v10 - v00), bottom = v01 + fu * (v11 - v01);
        return top + fv * (bottom - top);
    };
    return {between(c00.cb, c10.cb, c01.cb, c11.cb), between(c00.cr, c10.cr, c01.cr, c11.cr)};
}

}  // namespace tessera
