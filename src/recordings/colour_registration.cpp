#include "recordings/colour_registration.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tessera {
namespace {

constexpr float kAssumedDepth_m = 2;

// Bilinear; (u, v) must be inside.
Rgb8 SampleColour(const ColourImage& image, float u, float v) {
    const int x = std::min(static_cast<int>(u), image.width() - 2);
    const int y = std::min(static_cast<int>(v), image.height() - 2);
    const float a = u - static_cast<float>(x), b = v - static_cast<float>(y);
    const Rgb8 *upper = image.row(y) + x, *lower = image.row(y + 1) + x;
    const auto mix = [&](std::uint8_t p, std::uint8_t q, std::uint8_t r, std::uint8_t s) {
        const float above = static_cast<float>(p) * (1 - a) + static_cast<float>(q) * a;
        const float below = static_cast<float>(r) * (1 - a) + static_cast<float>(s) * a;
        return static_cast<std::uint8_t>(above * (1 - b) + below * b + 0.5f);
    };
    return {mix(upper[0].r, upper[1].r, lower[0].r, lower[1].r),
            mix(upper[0].g, upper[1].g, lower[0].g, lower[1].g),
            mix(upper[0].b, upper[1].b, lower[0].b, lower[1].b)};
}

// The pixel, with distortion, in which the colour camera sees a point. Behind it: far outside.
Eigen::Vector2f Seen(const PinholeCamera& camera, const LensDistortion& d,
                     const Eigen::Vector3f& p_colour) {
    if (p_colour.z() <= 0) return {-1e6f, -1e6f};
    const float x = p_colour.x() / p_colour.z(), y = p_colour.y() / p_colour.z();
    const float r2 = x * x + y * y;
    const auto k1 = static_cast<float>(d.k1), k2 = static_cast<float>(d.k2),
               k3 = static_cast<float>(d.k3), p1 = static_cast<float>(d.p1),
               p2 = static_cast<float>(d.p2);
    const float radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const float u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    const float v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
    return {u * static_cast<float>(camera.fx) + static_cast<float>(camera.cx),
            v * static_cast<float>(camera.fy) + static_cast<float>(camera.cy)};
}

PinholeCamera ShrunkBy(const PinholeCamera& camera, int n) {
    const auto centre = [n](double c) { return (c + 0.5) / n - 0.5; };
    return {camera.width / n, camera.height / n, camera.fx / n,
            camera.fy / n,    centre(camera.cx), centre(camera.cy)};
}

}  // namespace

bool IsRegistered(const RecordingInfo& info) {
    return info.depth_camera.pinhole == info.colour_camera.pinhole &&
           info.depth_camera.distortion == info.colour_camera.distortion &&
           info.T_colour_depth.matrix().isIdentity(1e-9);
}

ColourRegistration::ColourRegistration(const RecordingInfo& info, const PinholeCamera& depth_camera)
    : depth_camera_(depth_camera),
      distortion_(info.colour_camera.distortion),
      T_colour_depth_(info.T_colour_depth) {
    // A depth pixel that is several colour pixels wide gets their mean, not one of them.
    const PinholeCamera& full = info.colour_camera.pinhole;
    shrink_ = std::max(1, static_cast<int>(full.fx / depth_camera.fx + 0.25));
    shrink_ = std::min({shrink_, full.width / 2, full.height / 2});
    colour_camera_ = ShrunkBy(full, shrink_);
}

const ColourImage& ColourRegistration::Shrunk(const ColourImage& raw_colour) {
    if (shrink_ == 1) return raw_colour;
    shrunk_.Resize(colour_camera_.width, colour_camera_.height);
    const cv::Mat raw(raw_colour.height(), raw_colour.width(), CV_8UC3,
                      const_cast<Rgb8*>(raw_colour.data()));
    cv::Mat target(shrunk_.height(), shrunk_.width(), CV_8UC3, shrunk_.data());
    const cv::Rect whole_tiles(0, 0, shrunk_.width() * shrink_, shrunk_.height() * shrink_);
    cv::resize(raw(whole_tiles), target, target.size(), 0, 0, cv::INTER_AREA);
    return shrunk_;
}

void ColourRegistration::Register(const ColourImage& raw_colour, DepthImage& depth_m,
                                  ColourImage& colour) {
    const ColourImage& source = Shrunk(raw_colour);
    colour.Resize(depth_m.width(), depth_m.height());
    const Eigen::Isometry3f T = T_colour_depth_.cast<float>();
    const auto last_u = static_cast<float>(source.width() - 1),
               last_v = static_cast<float>(source.height() - 1);
    for (int y = 0; y < depth_m.height(); ++y) {
        float assumed_m = kAssumedDepth_m;
        for (int x = 0; x < depth_m.width(); ++x) {
            float& z_m = depth_m(x, y);
            if (z_m > 0) assumed_m = z_m;
            const Eigen::Vector3f p_depth = depth_camera_.Unproject(x, y, assumed_m).cast<float>();
            const Eigen::Vector2f at = Seen(colour_camera_, distortion_, T * p_depth);
            const bool inside = at.x() >= -0.5f && at.y() >= -0.5f && at.x() <= last_u + 0.5f &&
                                at.y() <= last_v + 0.5f;
            if (!inside) z_m = 0;
            colour(x, y) = inside ? SampleColour(source, std::clamp(at.x(), 0.0f, last_u),
                                                 std::clamp(at.y(), 0.0f, last_v))
                                  : Rgb8{};
        }
    }
}

}  // namespace tessera
