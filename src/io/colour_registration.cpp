#include "io/colour_registration.h"

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

// Where the lens puts the point (x, y) of the plane one metre ahead.
Eigen::Vector2f Distorted(const LensDistortion& d, float x, float y) {
    const float r2 = x * x + y * y;
    const auto k1 = static_cast<float>(d.k1), k2 = static_cast<float>(d.k2),
               k3 = static_cast<float>(d.k3), p1 = static_cast<float>(d.p1),
               p2 = static_cast<float>(d.p2);
    const float radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

PinholeCamera ShrunkBy(const PinholeCamera& camera, int n) {
    const auto centre = [n](double c) { return (c + 0.5) / n - 0.5; };
    return {camera.width / n, camera.height / n, camera.fx / n,
            camera.fy / n,    centre(camera.cx), centre(camera.cy)};
}

}  // namespace

void MoveColour(const Eigen::Vector2d& shift_px, CameraCalibration& calibration) {
    if (shift_px.isZero()) return;
    if (!calibration.colour)
        calibration.colour = ColourCamera{calibration.pinhole, calibration.distortion};
    PinholeCamera& colour = calibration.colour->pinhole;
    colour.cx += shift_px.x() * colour.fx / calibration.pinhole.fx;
    colour.cy += shift_px.y() * colour.fy / calibration.pinhole.fy;
}

Status CheckOneSize(const CameraCalibration& c) {
    if (!c.colour || (c.colour->pinhole.width == c.pinhole.width &&
                      c.colour->pinhole.height == c.pinhole.height))
        return Status::Ok();
    return Status::Error(fmt::format(
        "colour: {} x {} pixels, but here colour has the size of depth, {} x {}",
        c.colour->pinhole.width, c.colour->pinhole.height, c.pinhole.width, c.pinhole.height));
}

ColourRegistration::ColourRegistration(const ColourCamera& colour,
                                       const PinholeCamera& depth_camera)
    : raw_size_{colour.pinhole.width, colour.pinhole.height},
      depth_camera_(depth_camera),
      distortion_(colour.distortion),
      T_colour_depth_(colour.T_colour_depth) {
    // A depth pixel that is several colour pixels wide gets their mean, not one of them.
    const PinholeCamera& full = colour.pinhole;
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
    for (int y = 0; y < depth_m.height(); ++y)
        RegisterRow(source, y, depth_m.row(y), colour.row(y));
}

void ColourRegistration::RegisterRow(const ColourImage& source, int y, float* depth_m,
                                     Rgb8* colour) const {
    const Eigen::Matrix3f R = T_colour_depth_.linear().cast<float>();
    const Eigen::Vector3f t_m = T_colour_depth_.translation().cast<float>();
    const PinholeCamera &from = depth_camera_, &to = colour_camera_;
    // A pixel's ray in the colour camera's frame, per metre of depth: first + x * each.
    const Eigen::Vector3f each = R.col(0) / static_cast<float>(from.fx);
    const Eigen::Vector3f first = R.col(2) +
                                  R.col(1) * static_cast<float>((y - from.cy) / from.fy) -
                                  each * static_cast<float>(from.cx);
    const auto fx = static_cast<float>(to.fx), fy = static_cast<float>(to.fy),
               cx = static_cast<float>(to.cx), cy = static_cast<float>(to.cy);
    const auto last_u = static_cast<float>(source.width() - 1),
               last_v = static_cast<float>(source.height() - 1);
    const bool ideal = distortion_.IsZero();
    float assumed_m = kAssumedDepth_m;
    for (int x = 0; x < from.width; ++x) {
        if (depth_m[x] > 0) assumed_m = depth_m[x];
        const Eigen::Vector3f p = assumed_m * (first + static_cast<float>(x) * each) + t_m;
        Eigen::Vector2f at(p.x() / p.z(), p.y() / p.z());
        if (!ideal) at = Distorted(distortion_, at.x(), at.y());
        const float u = fx * at.x() + cx, v = fy * at.y() + cy;
        const bool inside =
            p.z() > 0 && u >= -0.5f && v >= -0.5f && u <= last_u + 0.5f && v <= last_v + 0.5f;
        if (!inside) depth_m[x] = 0;
        colour[x] =
            inside ? SampleColour(source, std::clamp(u, 0.0f, last_u), std::clamp(v, 0.0f, last_v))
                   : Rgb8{};
    }
}

}  // namespace tessera
