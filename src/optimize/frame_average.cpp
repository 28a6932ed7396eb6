#include "optimize/frame_average.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/se3.h"
#include "tracking/tile_view.h"

namespace tessera {
namespace {

constexpr int kMostFrames = 8;
constexpr double kMost_m = 0.05, kMost_rad = 0.08;
// Structured light's noise is 1.5 to 3 mm / m^2; the two poses add a few millimetres.
constexpr DepthMargin kSameSurface{.least_m = 0.01f, .per_m = 0.01f};

// For each pixel of `first`, adds the depth that `depth_m` shows of the same surface: where a pixel
// falls, bilinear between four measurements of one surface.
void AddSeenFrom(const DepthImage& first_m, const DepthImage& depth_m, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_this_first, Image<float>& sum_m,
                 Image<float>& samples) {
    const Eigen::Matrix3f R = T_this_first.linear().cast<float>();
    const Eigen::Vector3f t = T_this_first.translation().cast<float>();
    const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy),
               cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
    Eigen::Matrix3f K;
    K << fx, 0, cx, 0, fy, cy, 0, 0, 1;
    const Eigen::Vector3f offset = K * t;
    const float* pixels = depth_m.data();
    const std::ptrdiff_t width = depth_m.width();
    const auto right = static_cast<float>(depth_m.width() - 1),
               below = static_cast<float>(depth_m.height() - 1);
    tbb::parallel_for(0, first_m.height(), [&](int y) {
        // The ray of pixel x, in this frame's pixels and metres: left + x * step.
        const Eigen::Vector3f step = K * R.col(0) / fx,
                              left = K * (R.col(1) * ((static_cast<float>(y) - cy) / fy) +
                                          R.col(2) - R.col(0) * (cx / fx));
        const float* z_first = first_m.row(y);
        float *sum = sum_m.row(y), *count = samples.row(y);
        for (int x = 0; x < first_m.width(); ++x) {
            const float z = z_first[x];
            if (!(z > 0)) continue;
            const auto column = static_cast<float>(x);
            const float expected = z * (left.z() + column * step.z()) + offset.z(),
                        inverse = 1 / expected;
            const float u = (z * (left.x() + column * step.x()) + offset.x()) * inverse,
                        v = (z * (left.y() + column * step.y()) + offset.y()) * inverse;
            if (!(expected > 0 && u >= 0 && v >= 0 && u < right && v < below)) continue;
            const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
            const float fu = u - static_cast<float>(u0), fv = v - static_cast<float>(v0);
            const float* a = pixels + v0 * width + u0;
            const float* b = a + width;
            const float most = kSameSurface(z);
            const float nearest = std::min(std::min(a[0], a[1]), std::min(b[0], b[1])),
                        farthest = std::max(std::max(a[0], a[1]), std::max(b[0], b[1]));
            if (!(nearest > expected - most && farthest < expected + most)) continue;
            const float seen =
                (1 - fv) * (a[0] + fu * (a[1] - a[0])) + fv * (b[0] + fu * (b[1] - b[0]));
            sum[x] += z + seen - expected;
            count[x] += 1;
        }
    });
}

}  // namespace

void FrameAverage::Begin(const Frame& frame, const PinholeCamera& camera,
                         const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view) {
    frame_ = frame;
    camera_ = camera;
    T_keyframe_camera_ = T_keyframe_camera;
    view_ = view;
    count_ = 1;
    sum_m_ = frame.depth_m;
    samples_.Resize(frame.depth_m.width(), frame.depth_m.height());
    std::fill(samples_.data(), samples_.data() + samples_.size(), 1.0f);
}

bool FrameAverage::Add(const Frame& frame, const Eigen::Isometry3d& T_keyframe_camera,
                       const Integrator::View& view) {
    const Eigen::Isometry3d T_this_first = T_keyframe_camera.inverse() * T_keyframe_camera_;
    if (count_ == 0 || count_ == kMostFrames || T_this_first.translation().norm() > kMost_m ||
        RotationAngle(T_this_first, Eigen::Isometry3d::Identity()) > kMost_rad ||
        frame.colour.empty() != frame_.colour.empty() ||
        (view.colour_weight > 0) != (view_.colour_weight > 0))
        return false;
    AddSeenFrom(frame_.depth_m, frame.depth_m, camera_, T_this_first, sum_m_, samples_);
    view_.weight += view.weight;
    view_.colour_weight += view.colour_weight;
    ++count_;
    return true;
}

const Frame& FrameAverage::Take() {
    count_ = 0;
    for (std::size_t i = 0; i < sum_m_.size(); ++i)
        frame_.depth_m.data()[i] = sum_m_.data()[i] / samples_.data()[i];
    return frame_;
}

}  // namespace tessera
