#include "tracking/frame_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tracking/normal_equations.h"

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

// Three measured depths in a row that may belong to one surface.
bool Smooth(float before, float here, float after) {
    constexpr float kBend = 0.03f;  // of the depth
    return before > 0 && after > 0 && std::abs(before + after - 2 * here) < kBend * here;
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

void FramePoints::EstimateNormals(const PreparedFrame& frame, const PinholeCamera& camera, int radius_px) {
    for (auto* values : {&normal_x, &normal_y, &normal_z}) values->assign(static_cast<std::size_t>(count()), 0.0f);
    const DepthImage& depth = frame.depth_m;
    const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
    const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
    const auto at = [&](int u, int v) {
        const float d = depth(u, v);
        return Eigen::Vector3f((static_cast<float>(u) - cx) / fx * d, (static_cast<float>(v) - cy) / fy * d, d);
    };
    std::vector<std::int64_t> dropped(static_cast<std::size_t>(height_), 0);
    tbb::parallel_for(0, height_, [&](int row) {
        const int v = ImageRow(row), up = std::max(v - radius_px, 0), down = std::min(v + radius_px, depth.height() - 1);
        for (int column = 0; column < width_; ++column) {
            const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                                  static_cast<std::size_t>(column);
            if (weight[i] <= 0) continue;
            const int u = column * step_ + step_ / 2;
            const int left = std::max(u - radius_px, 0), right = std::min(u + radius_px, depth.width() - 1);
            const float d = depth(u, v);
            if (!Smooth(depth(left, v), d, depth(right, v)) || !Smooth(depth(u, up), d, depth(u, down))) {
                weight[i] = 0;
                ++dropped[static_cast<std::size_t>(row)];
                continue;
            }
            const Eigen::Vector3f n = (at(u, down) - at(u, up)).cross(at(right, v) - at(left, v)).normalized();
            normal_x[i] = n.x();
            normal_y[i] = n.y();
            normal_z[i] = n.z();
        }
    });
    valid_ -= std::accumulate(dropped.begin(), dropped.end(), std::int64_t{0});
}

void FramePoints::SampleIntensity(const PreparedFrame& frame, const PinholeCamera& camera,
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
