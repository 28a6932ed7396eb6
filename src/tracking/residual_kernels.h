// Sums over neighbourhoods of a frame's finest points, from which the residual model learns. Each
// kind of sums is a struct: kSums sums for each of Groups(a), added up over Parts(a) in order.
// Host-device, shared by the CPU code and CUDA; in double.
#pragma once

#include <cmath>

#include "core/host_device.h"
#include "core/row_time.h"

namespace tessera {

// Side of the patches over which errors are assumed to be shared, in points, for points in rows of
// this width: a fortieth of the image at any resolution.
TESSERA_HD int PatchSide(int width) { return width >= 80 ? (width + 20) / 40 : 2; }

struct ResidualArguments {
    // The points, row by row, at every step-th pixel (FramePoints). Residuals are NaN where
    // unknown.
    int width, height, step;
    const float *x, *y, *z, *intensity, *weight;
    const float *distance_residual, *intensity_residual;
    const float* gradient[3];  // of the distances
    // The frame's intensities and the camera.
    const float* image;
    int image_width, image_height;
    double fx, fy, cx, cy;
    double rotation[9];  // from the camera's axes to those of the gradients, row-major
    double distance_scale_m, intensity_scale;  // Huber scales of the sums that found the pose
    // FrameMotion of the points, the frame's gain, and the Huber scale of the shutter's sums.
    double twist_per_s[6];
    double colour_delay_s, colour_readout_s;
    double gain, residual_scale;
    bool has_intensity, wants_shutter;  // which sums to compute

    TESSERA_HD_MEMBER int At(int column, int row) const { return row * width + column; }
    // Of DistanceSums. Two by two patches form a block.
    TESSERA_HD_MEMBER int Patch() const { return PatchSide(width); }
    TESSERA_HD_MEMBER double HuberedWeight(int i, double residual, double scale) const {
        const double size = std::fabs(residual);
        return size > scale ? weight[i] * (scale / size) : weight[i];
    }
};

// Sums of a patch; the four patches of a block are consecutive. The sums are the weight, the weight
// times the Jacobian, and the score: the weight times the Jacobian times the distance. Jacobians
// are for increments (rotation, translation) about the camera in the axes of the gradients.
struct DistanceSums {
    static constexpr int kSums = 13, kJacobian = 1, kScore = 7;
    TESSERA_HD_MEMBER static int Columns(const ResidualArguments& a) {
        return a.width / (2 * a.Patch());
    }  // in blocks
    TESSERA_HD_MEMBER static int Groups(const ResidualArguments& a) {
        return 4 * Columns(a) * (a.height / (2 * a.Patch()));
    }
    TESSERA_HD_MEMBER static int Parts(const ResidualArguments& a) { return a.Patch(); }
    TESSERA_HD_MEMBER static void Add(const ResidualArguments& a, int group, int part,
                                      double* sums) {
        const int block = group / 4, x0 = (2 * (block % Columns(a)) + group % 2) * a.Patch();
        const int y = (2 * (block / Columns(a)) + group % 4 / 2) * a.Patch() + part;
        for (int i = a.At(x0, y); i < a.At(x0 + a.Patch(), y); ++i) {
            const double r = a.distance_residual[i];
            if (std::isnan(r)) continue;
            const double w = a.HuberedWeight(i, r, a.distance_scale_m);
            double p[3], g[3];
            for (int k = 0; k < 3; ++k) {
                const double* row = a.rotation + 3 * k;
                p[k] = row[0] * a.x[i] + row[1] * a.y[i] + row[2] * a.z[i];
                g[k] = a.gradient[k][i];
            }
            const double j[6] = {p[1] * g[2] - p[2] * g[1],
                                 p[2] * g[0] - p[0] * g[2],
                                 p[0] * g[1] - p[1] * g[0],
                                 g[0],
                                 g[1],
                                 g[2]};
            sums[0] += w;
            for (int k = 0; k < 6; ++k) {
                sums[kJacobian + k] += w * j[k];
                sums[kScore + k] += w * j[k] * r;
            }
        }
    }
};

// Intensity sums of a block, with the image gradient divided by depth (the effect of a sideways
// motion). All are weighted: residual times gradient, in both directions; the gradient, in both
// directions; its square; and where the map's gradient is known: the product of the two, the square
// of the map's, the weight, and the map's, in both directions.
struct ScoreSums {
    static constexpr int kSums = 10;
    TESSERA_HD_MEMBER static int Side(const ResidualArguments& a) { return 2 * a.Patch(); }
    TESSERA_HD_MEMBER static int Columns(const ResidualArguments& a) {
        return (a.width - 2) / Side(a);
    }
    TESSERA_HD_MEMBER static int Groups(const ResidualArguments& a) {
        return Columns(a) * ((a.height - 2) / Side(a));
    }
    TESSERA_HD_MEMBER static int Parts(const ResidualArguments& a) { return Side(a); }
    TESSERA_HD_MEMBER static void Add(const ResidualArguments& a, int group, int part,
                                      double* sums) {
        const int x0 = 1 + group % Columns(a) * Side(a),
                  y = 1 + group / Columns(a) * Side(a) + part;
        for (int i = a.At(x0, y); i < a.At(x0 + Side(a), y); ++i) {
            const int left = i - 1, right = i + 1, up = i - a.width, down = i + a.width;
            const double r = a.intensity_residual[i], z = a.z[i];
            if (std::isnan(r) || z <= 0 || a.intensity[left] < 0 || a.intensity[right] < 0 ||
                a.intensity[up] < 0 || a.intensity[down] < 0)
                continue;
            const double w = a.HuberedWeight(i, r, a.intensity_scale);
            const double gu = a.gain * (a.intensity[right] - a.intensity[left]) / z;
            const double gv = a.gain * (a.intensity[down] - a.intensity[up]) / z;
            sums[0] += w * r * gu;
            sums[1] += w * r * gv;
            sums[2] += w * gu;
            sums[3] += w * gv;
            sums[4] += w * (gu * gu + gv * gv);
            // The map's intensity is residual + gain * image + offset.
            const double mu =
                gu +
                (static_cast<double>(a.intensity_residual[right]) - a.intensity_residual[left]) / z;
            const double mv =
                gv +
                (static_cast<double>(a.intensity_residual[down]) - a.intensity_residual[up]) / z;
            const double map2 = mu * mu + mv * mv;
            if (std::isnan(map2)) continue;
            sums[5] += w * (gu * mu + gv * mv);
            sums[6] += w * map2;
            sums[7] += w;
            sums[8] += w * mu;
            sums[9] += w * mv;
        }
    }
};

// Sums of a part of every kRowStep-th row of points: the normal equations of the colour image's
// delay and read-out time, upper triangle (3), then the gradient (2). A subset of the points is
// enough, and cheap.
struct ShutterSums {
    static constexpr int kSums = 5;
    static constexpr int kRowStep = 3, kColumnStep = 2, kPart = 32;
    TESSERA_HD_MEMBER static int Groups(const ResidualArguments& a) {
        return (a.height + kRowStep - 1) / kRowStep;
    }
    TESSERA_HD_MEMBER static int Parts(const ResidualArguments& a) {
        return (a.width + kPart - 1) / kPart;
    }
    TESSERA_HD_MEMBER static void Add(const ResidualArguments& a, int group, int part,
                                      double* sums) {
        const int row = group * kRowStep, image_row = row * a.step + a.step / 2;
        const double time =
            a.colour_delay_s + RowTime(a.colour_readout_s, image_row, a.image_height);
        const double share = RowTime(1.0, image_row, a.image_height);
        const int end = (part + 1) * kPart < a.width ? (part + 1) * kPart : a.width;
        for (int column = part * kPart; column < end; column += kColumnStep)
            AddPoint(a, a.At(column, row), time, share, sums);
    }

  private:
    TESSERA_HD_MEMBER static void AddPoint(const ResidualArguments& a, int i, double time,
                                           double share, double* sums) {
        const double residual = a.intensity_residual[i];
        if (std::isnan(residual)) return;
        const double *turn = a.twist_per_s, *move = a.twist_per_s + 3;
        const double p[3] = {a.x[i], a.y[i], a.z[i]};
        // The point's velocity as seen from the moving camera.
        const double velocity[3] = {-(turn[1] * p[2] - turn[2] * p[1] + move[0]),
                                    -(turn[2] * p[0] - turn[0] * p[2] + move[1]),
                                    -(turn[0] * p[1] - turn[1] * p[0] + move[2])};
        double q[3];
        for (int k = 0; k < 3; ++k) q[k] = p[k] + time * velocity[k];
        if (!(q[2] >= 0.1)) return;
        // Central differences of the image at the nearest pixel.
        const double u = a.fx * q[0] / q[2] + a.cx, v = a.fy * q[1] / q[2] + a.cy;
        if (!(u >= 1 && v >= 1 && u < a.image_width - 2 && v < a.image_height - 2)) return;
        const float* pixel =
            a.image + static_cast<int>(v + 0.5) * a.image_width + static_cast<int>(u + 0.5);
        const double du = 0.5 * (pixel[1] - pixel[-1]),
                     dv = 0.5 * (pixel[a.image_width] - pixel[-a.image_width]);
        const double flow_u = a.fx * (velocity[0] - q[0] / q[2] * velocity[2]) / q[2];
        const double flow_v = a.fy * (velocity[1] - q[1] / q[2] * velocity[2]) / q[2];
        const double slope = -a.gain * (du * flow_u + dv * flow_v);  // d(residual)/d(time)
        const double j[2] = {slope, slope * share};
        const double w = a.HuberedWeight(i, residual, a.residual_scale);
        sums[0] += w * j[0] * j[0];
        sums[1] += w * j[0] * j[1];
        sums[2] += w * j[1] * j[1];
        sums[3] += w * residual * j[0];
        sums[4] += w * residual * j[1];
    }
};

}  // namespace tessera
