// What Photometry learns from a frame's residuals, as sums over neighbourhoods of its finest points. Each kind of sums is a struct:
// kSums sums for each of Groups(a), added up over Parts(a) in their order. Host-device, shared by the CPU and CUDA; in double.
#pragma once

#include <cmath>

#include "core/host_device.h"
#include "core/row_time.h"

namespace tessera {

struct ResidualArguments {
    // The points, row by row, every step-th pixel: FramePoints; residuals are NaN where unknown.
    int width, height, step;
    const float *x, *y, *z, *intensity, *weight;
    const float *distance_residual, *intensity_residual;
    // The frame's intensities and the camera.
    const float* image;
    int image_width, image_height;
    double fx, fy, cx, cy;
    // FrameMotion of the points, the frame's gain, and Huber's scale of the shutter's sums.
    double twist_per_s[6];
    double colour_delay_s, colour_readout_s;
    double gain, residual_scale;
    bool wants_alpha, wants_shutter;  // which sums

    TESSERA_HD_MEMBER int At(int column, int row) const { return row * width + column; }
};

inline constexpr int kResidualBlock = 16;  // a block of points, a side

// Distances of a block: their sum, how many are known.
struct DistanceSums {
    static constexpr int kSums = 2;
    TESSERA_HD_MEMBER static int Columns(const ResidualArguments& a) { return a.width / kResidualBlock; }
    TESSERA_HD_MEMBER static int Groups(const ResidualArguments& a) { return Columns(a) * (a.height / kResidualBlock); }
    TESSERA_HD_MEMBER static int Parts(const ResidualArguments&) { return kResidualBlock; }
    TESSERA_HD_MEMBER static void Add(const ResidualArguments& a, int group, int part, double* sums) {
        const int x = group % Columns(a) * kResidualBlock, y = group / Columns(a) * kResidualBlock + part;
        for (int i = 0; i < kResidualBlock; ++i) {
            const float r = a.distance_residual[a.At(x + i, y)];
            if (std::isnan(r)) continue;
            sums[0] += r;
            sums[1] += 1;
        }
    }
};

// Intensities of a block, with the image's gradient over depth (what a sideways move changes): residual times gradient, both
// directions; the gradients; their squares; how many are known.
struct ScoreSums {
    static constexpr int kSums = 6;
    TESSERA_HD_MEMBER static int Columns(const ResidualArguments& a) { return (a.width - 2) / kResidualBlock; }
    TESSERA_HD_MEMBER static int Groups(const ResidualArguments& a) { return Columns(a) * ((a.height - 2) / kResidualBlock); }
    TESSERA_HD_MEMBER static int Parts(const ResidualArguments&) { return kResidualBlock; }
    TESSERA_HD_MEMBER static void Add(const ResidualArguments& a, int group, int part, double* sums) {
        const int x0 = 1 + group % Columns(a) * kResidualBlock, y = 1 + group / Columns(a) * kResidualBlock + part;
        for (int x = x0; x < x0 + kResidualBlock; ++x) {
            const float r = a.intensity_residual[a.At(x, y)], z = a.z[a.At(x, y)];
            const float left = a.intensity[a.At(x - 1, y)], right = a.intensity[a.At(x + 1, y)];
            const float up = a.intensity[a.At(x, y - 1)], down = a.intensity[a.At(x, y + 1)];
            if (std::isnan(r) || z <= 0 || left < 0 || right < 0 || up < 0 || down < 0) continue;
            const double gu = (right - left) / z, gv = (down - up) / z;
            sums[0] += r * gu;
            sums[1] += r * gv;
            sums[2] += gu;
            sums[3] += gv;
            sums[4] += gu * gu + gv * gv;
            sums[5] += 1;
        }
    }
};

// Of some rows of points, parts of a row: the normal equations of the colour image's delay and read-out time, upper triangle
// (3), then the gradient (2). Some points of a row: enough, and cheap.
struct ShutterSums {
    static constexpr int kSums = 5;
    static constexpr int kRowStep = 3, kColumnStep = 2, kPart = 32;
    TESSERA_HD_MEMBER static int Groups(const ResidualArguments& a) { return (a.height + kRowStep - 1) / kRowStep; }
    TESSERA_HD_MEMBER static int Parts(const ResidualArguments& a) { return (a.width + kPart - 1) / kPart; }
    TESSERA_HD_MEMBER static void Add(const ResidualArguments& a, int group, int part, double* sums) {
        const int row = group * kRowStep, image_row = row * a.step + a.step / 2;
        const double time = a.colour_delay_s + RowTime(a.colour_readout_s, image_row, a.image_height);
        const double share = RowTime(1.0, image_row, a.image_height);
        const int end = (part + 1) * kPart < a.width ? (part + 1) * kPart : a.width;
        for (int column = part * kPart; column < end; column += kColumnStep)
            AddPoint(a, a.At(column, row), time, share, sums);
    }

  private:
    TESSERA_HD_MEMBER static void AddPoint(const ResidualArguments& a, int i, double time, double share, double* sums) {
        const double residual = a.intensity_residual[i];
        if (std::isnan(residual)) return;
        const double *turn = a.twist_per_s, *move = a.twist_per_s + 3;
        const double p[3] = {a.x[i], a.y[i], a.z[i]};
        const double velocity[3] = {-(turn[1] * p[2] - turn[2] * p[1] + move[0]),  // of the point, seen from the moving camera
                                    -(turn[2] * p[0] - turn[0] * p[2] + move[1]), -(turn[0] * p[1] - turn[1] * p[0] + move[2])};
        double q[3];
        for (int k = 0; k < 3; ++k) q[k] = p[k] + time * velocity[k];
        if (!(q[2] >= 0.1)) return;
        // Central differences of the image at the nearest pixel.
        const double u = a.fx * q[0] / q[2] + a.cx, v = a.fy * q[1] / q[2] + a.cy;
        if (!(u >= 1 && v >= 1 && u < a.image_width - 2 && v < a.image_height - 2)) return;
        const float* pixel = a.image + static_cast<int>(v + 0.5) * a.image_width + static_cast<int>(u + 0.5);
        const double du = 0.5 * (pixel[1] - pixel[-1]), dv = 0.5 * (pixel[a.image_width] - pixel[-a.image_width]);
        const double flow_u = a.fx * (velocity[0] - q[0] / q[2] * velocity[2]) / q[2];
        const double flow_v = a.fy * (velocity[1] - q[1] / q[2] * velocity[2]) / q[2];
        const double slope = -a.gain * (du * flow_u + dv * flow_v);  // d(residual)/d(time)
        const double j[2] = {slope, slope * share};
        const double size = std::fabs(residual);
        const double w = size > a.residual_scale ? a.weight[i] * (a.residual_scale / size) : a.weight[i];
        sums[0] += w * j[0] * j[0];
        sums[1] += w * j[0] * j[1];
        sums[2] += w * j[1] * j[1];
        sums[3] += w * residual * j[0];
        sums[4] += w * residual * j[1];
    }
};

}  // namespace tessera
