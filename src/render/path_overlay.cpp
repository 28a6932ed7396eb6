#include "render/path_overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace tessera {
namespace {

constexpr double kNear_m = 0.01;
constexpr int kSubpixelBits = 4;
constexpr std::size_t kFrusta = 8;  // at most

// Draws world-frame segments into an image.
class Pen {
  public:
    Pen(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera, ColourImage& image)
        : camera_(camera),
          T_camera_world_(T_world_camera.inverse()),
          canvas_(image.height(), image.width(), CV_8UC3, image.data()),
          thickness_(std::max(1, image.width() / 1000)) {}

    void Line(const Eigen::Vector3d& p_world, const Eigen::Vector3d& q_world, const Rgb8& colour) {
        Eigen::Vector3d p = T_camera_world_ * p_world, q = T_camera_world_ * q_world;
        if (p.z() > q.z()) std::swap(p, q);
        if (!(q.z() > kNear_m)) return;  // behind the camera, or no number
        if (p.z() < kNear_m) p += (kNear_m - p.z()) / (q.z() - p.z()) * (q - p);
        cv::Point a = Pixel(p), b = Pixel(q);
        cv::line(canvas_, a, b, {double(colour.r), double(colour.g), double(colour.b)}, thickness_,
                 cv::LINE_AA, kSubpixelBits);
    }

  private:
    cv::Point Pixel(const Eigen::Vector3d& p_camera) const {
        const auto fixed = [](double x) {  // far outside is drawn as just outside
            return static_cast<int>(std::lround(std::clamp(x, -2e4, 2e4) * (1 << kSubpixelBits)));
        };
        const Eigen::Vector2d pixel = camera_.Project(p_camera);
        return {fixed(pixel.x()), fixed(pixel.y())};
    }

    const PinholeCamera& camera_;
    Eigen::Isometry3d T_camera_world_;
    cv::Mat canvas_;
    int thickness_;
};

// A pyramid from the camera's centre to a 4:3 picture `depth_m` in front of it.
void DrawFrustum(const Eigen::Isometry3d& T_world_camera, double depth_m, const Rgb8& colour,
                 Pen& pen) {
    const double x = 0.6 * depth_m, y = 0.45 * depth_m;
    const Eigen::Vector3d centre = T_world_camera.translation();
    const std::array<Eigen::Vector3d, 4> corners = {
        T_world_camera * Eigen::Vector3d(-x, -y, depth_m),
        T_world_camera * Eigen::Vector3d(x, -y, depth_m),
        T_world_camera * Eigen::Vector3d(x, y, depth_m),
        T_world_camera * Eigen::Vector3d(-x, y, depth_m)};
    for (std::size_t i = 0; i < 4; ++i) {
        pen.Line(centre, corners[i], colour);
        pen.Line(corners[i], corners[(i + 1) % 4], colour);
    }
}

// A depth that looks alike in every picture: a fixed share of it at the path's mean distance.
double FrustumDepth(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                    const RenderStyle& style) {
    if (style.frustum_m > 0) return style.frustum_m;
    double distance_m = 0;
    for (const auto& pose : style.path)
        distance_m += (pose.translation() - T_world_camera.translation()).norm();
    distance_m /= static_cast<double>(style.path.size());
    return 0.035 * distance_m * camera.width / camera.fx;
}

}  // namespace

void DrawPath(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
              const RenderStyle& style, ColourImage& image) {
    const auto& path = style.path;
    if (path.empty()) return;
    Pen pen(camera, T_world_camera, image);
    for (std::size_t i = 1; i < path.size(); ++i)
        pen.Line(path[i - 1].translation(), path[i].translation(), style.path_colour);
    const double depth_m = FrustumDepth(camera, T_world_camera, style);
    const std::size_t step = (path.size() + kFrusta - 1) / kFrusta;
    for (std::size_t i = 0; i < path.size(); i += step)
        DrawFrustum(path[i], depth_m, style.path_colour, pen);
}

}  // namespace tessera
