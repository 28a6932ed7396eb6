#include "tracking/frame_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tracking/normal_equations.h"
#include "tracking/point_kernels.h"

namespace tessera {
namespace {

PinholeImage WithCamera(const Image<float>& image, const PinholeCamera& camera) {
    return {image.data(), image.width(), image.height(), static_cast<float>(camera.fx), static_cast<float>(camera.fy),
            static_cast<float>(camera.cx), static_cast<float>(camera.cy)};
}

}  // namespace

void FramePoints::Build(const PreparedFrame& frame, const PinholeCamera& camera, const FrameMotion& motion, int step,
                      double depth_exponent) {
    const DepthImage& depth = frame.depth_m;
    const int columns = (depth.width() + step - 1 - step / 2) / step;
    step_ = step;
    width_ = (columns + kPointPadding - 1) / kPointPadding * kPointPadding;
    height_ = (depth.height() + step - 1 - step / 2) / step;
    for (auto* values : {&x, &y, &z, &weight}) values->assign(static_cast<std::size_t>(count()), 0.0f);
    intensity.assign(static_cast<std::size_t>(count()), -1.0f);
    std::vector<std::int64_t> valid(static_cast<std::size_t>(height_), 0);
    const Eigen::Matrix<float, 6, 1> twist = motion.twist_per_s.cast<float>();
    const auto exponent = static_cast<float>(-depth_exponent);
    tbb::parallel_for(0, height_, [&](int row) {
        const int v = ImageRow(row);
        const float ray_y = RaySlope(v, camera.cy, camera.fy);
        const float* line = depth.row(v);
        const auto time = static_cast<float>(motion.DepthTime(v, depth.height()));
        std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
        for (int u = step / 2; u < depth.width(); u += step, ++at) {
            const float d = line[u];
            if (d <= 0) continue;
            const CameraPoint p = Moved({RaySlope(u, camera.cx, camera.fx) * d, ray_y * d, d}, twist.data(), time);
            x[at] = p.x;
            y[at] = p.y;
            z[at] = p.z;
            weight[at] = PointWeight(d, exponent);
            ++valid[static_cast<std::size_t>(row)];
        }
    });
    valid_ = std::accumulate(valid.begin(), valid.end(), std::int64_t{0});
}

void FramePoints::EstimateNormals(const PreparedFrame& frame, const PinholeCamera& camera, int radius_px) {
    for (auto* values : {&normal_x, &normal_y, &normal_z}) values->assign(static_cast<std::size_t>(count()), 0.0f);
    const PinholeImage depth = WithCamera(frame.depth_m, camera);
    std::vector<std::int64_t> dropped(static_cast<std::size_t>(height_), 0);
    tbb::parallel_for(0, height_, [&](int row) {
        for (int column = 0; column < width_; ++column) {
            const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                                  static_cast<std::size_t>(column);
            if (weight[i] <= 0) continue;
            CameraPoint n;
            if (!NormalAt(depth, column * step_ + step_ / 2, ImageRow(row), radius_px, n)) {
                weight[i] = 0;
                ++dropped[static_cast<std::size_t>(row)];
                continue;
            }
            normal_x[i] = n.x;
            normal_y[i] = n.y;
            normal_z[i] = n.z;
        }
    });
    valid_ -= std::accumulate(dropped.begin(), dropped.end(), std::int64_t{0});
}

void FramePoints::SampleIntensity(const PreparedFrame& frame, const PinholeCamera& camera,
                                const FrameMotion& motion) {
    if (!frame.has_colour()) return;
    const bool still = motion.twist_per_s.isZero();
    const Eigen::Matrix<float, 6, 1> twist = motion.twist_per_s.cast<float>();
    const PinholeImage image = WithCamera(frame.intensity, camera);
    tbb::parallel_for(0, height_, [&](int row) {
        const std::size_t begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
        const int v = ImageRow(row);
        const auto time = static_cast<float>(motion.ColourTime(v, frame.depth_m.height()));
        for (int column = 0; column < width_; ++column) {
            const std::size_t i = begin + static_cast<std::size_t>(column);
            if (weight[i] <= 0) continue;
            if (still) {
                intensity[i] = frame.intensity(column * step_ + step_ / 2, v);
                continue;
            }
            intensity[i] = SampleAtPoint(image, Moved({x[i], y[i], z[i]}, twist.data(), -time));
        }
    });
}

}  // namespace tessera
