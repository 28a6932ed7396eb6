#include "tracking/sdf_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tracking/sdf_rows.h"

namespace tessera {
namespace {

// Bilinear; -1 outside.
float Sample(const Image<float>& image, float u, float v) {
    if (!(u >= 0 && v >= 0 && u < static_cast<float>(image.width() - 1) &&
          v < static_cast<float>(image.height() - 1)))
        return -1.0f;
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const float fu = u - static_cast<float>(x), fv = v - static_cast<float>(y);
    const float* above = image.row(y) + x;
    const float* below = image.row(y + 1) + x;
    const float top = above[0] + fu * (above[1] - above[0]);
    const float bottom = below[0] + fu * (below[1] - below[0]);
    return top + fv * (bottom - top);
}

}  // namespace

void SdfPoints::Build(const PreparedFrame& frame, const PinholeCamera& camera, const FrameMotion& motion, int step,
                      double depth_exponent) {
    const DepthImage& depth = frame.depth_m;
    const int columns = (depth.width() + step - 1 - step / 2) / step;
    step_ = step;
    width_ = (columns + kSdfPointPadding - 1) / kSdfPointPadding * kSdfPointPadding;
    height_ = (depth.height() + step - 1 - step / 2) / step;
    for (auto* values : {&x, &y, &z, &weight}) values->assign(static_cast<std::size_t>(count()), 0.0f);
    intensity.assign(static_cast<std::size_t>(count()), -1.0f);
    std::vector<std::int64_t> valid(static_cast<std::size_t>(height_), 0);
    const Eigen::Vector3f turn = motion.twist_per_s.head<3>().cast<float>();
    const Eigen::Vector3f move = motion.twist_per_s.tail<3>().cast<float>();
    const auto exponent = static_cast<float>(-depth_exponent);
    tbb::parallel_for(0, height_, [&](int row) {
        const int v = ImageRow(row);
        const float ray_y = static_cast<float>((v - camera.cy) / camera.fy);
        const float* line = depth.row(v);
        const auto time = static_cast<float>(motion.DepthTime(v, depth.height()));
        std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
        for (int u = step / 2; u < depth.width(); u += step, ++at) {
            const float d = line[u];
            if (d <= 0) continue;
            Eigen::Vector3f p(static_cast<float>((u - camera.cx) / camera.fx) * d, ray_y * d, d);  // [B14] eq. 1
            p += time * (turn.cross(p) + move);
            x[at] = p.x();
            y[at] = p.y();
            z[at] = p.z();
            weight[at] = exponent == -2.0f ? 1.0f / std::max(d * d, 0.25f) : std::pow(std::max(d, 0.5f), exponent);
            ++valid[static_cast<std::size_t>(row)];
        }
    });
    valid_ = std::accumulate(valid.begin(), valid.end(), std::int64_t{0});
}

void SdfPoints::SampleIntensity(const PreparedFrame& frame, const PinholeCamera& camera,
                                const FrameMotion& motion) {
    if (!frame.has_colour()) return;
    const bool still = motion.twist_per_s.isZero();
    const Eigen::Vector3f turn = motion.twist_per_s.head<3>().cast<float>();
    const Eigen::Vector3f move = motion.twist_per_s.tail<3>().cast<float>();
    const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
    const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
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
            Eigen::Vector3f p(x[i], y[i], z[i]);
            p -= time * (turn.cross(p) + move);
            intensity[i] = p.z() > 0.05f ? Sample(frame.intensity, p.x() / p.z() * fx + cx, p.y() / p.z() * fy + cy)
                                         : -1.0f;
        }
    });
}

}  // namespace tessera
