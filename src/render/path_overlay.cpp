#include "render/path_overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "render/annotation.h"

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
          image_(image),
          canvas_(image.height(), image.width(), CV_8UC3, image.data()),
          thickness_(std::max(1, image.width() / 1000)) {}

    void Line(const Eigen::Vector3d& p_world, const Eigen::Vector3d& q_world, const Rgb8& colour) {
        Eigen::Vector3d p = T_camera_world_ * p_world, q = T_camera_world_ * q_world;
        if (p.z() > q.z()) std::swap(p, q);
        if (!(q.z() > kNear_m)) return;  // behind the camera, or NaN
        if (p.z() < kNear_m) p += (kNear_m - p.z()) / (q.z() - p.z()) * (q - p);
        cv::Point a = Pixel(p), b = Pixel(q);
        cv::line(canvas_, a, b, {double(colour.r), double(colour.g), double(colour.b)}, thickness_,
                 cv::LINE_AA, kSubpixelBits);
    }

    // Writes above `p_world`, on a plate of this colour. Draws nothing behind the camera.
    void Write(const Eigen::Vector3d& p_world, const std::string& text, const Rgb8& colour) {
        const Eigen::Vector3d p = T_camera_world_ * p_world;
        if (!(p.z() > kNear_m)) return;
        const cv::Point middle = Pixel(p);
        DrawPlate(middle.x >> kSubpixelBits, middle.y >> kSubpixelBits, text, colour, image_);
    }

  private:
    cv::Point Pixel(const Eigen::Vector3d& p_camera) const {
        const auto fixed = [](double x) {  // keeps coordinates far outside the image in range
            return static_cast<int>(std::lround(std::clamp(x, -2e4, 2e4) * (1 << kSubpixelBits)));
        };
        const Eigen::Vector2d pixel = camera_.Project(p_camera);
        return {fixed(pixel.x()), fixed(pixel.y())};
    }

    const PinholeCamera& camera_;
    Eigen::Isometry3d T_camera_world_;
    ColourImage& image_;
    cv::Mat canvas_;
    int thickness_;
};

// Draws a pyramid from the camera centre to a 4:3 image plane `depth_m` in front of it.
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

// A depth that looks alike in every picture: a fixed fraction of it at the path's mean distance.
double FrustumDepth(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                    const RenderStyle& style) {
    if (style.frustum_m > 0) return style.frustum_m;
    double distance_m = 0;
    for (const auto& pose : style.path)
        distance_m += (pose.translation() - T_world_camera.translation()).norm();
    distance_m /= static_cast<double>(style.path.size());
    return 0.035 * distance_m * camera.width / camera.fx;
}

Eigen::Vector3d Corner(const NamedBox& box, int i) {
    const Eigen::Vector3d sign((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                               (i & 4) != 0 ? 0.5 : -0.5);
    return box.T_world_box * sign.cwiseProduct(box.size);
}

// Above the box's centre, at the height of its highest corner in the picture.
Eigen::Vector3d NamePlace(const NamedBox& box, const Eigen::Isometry3d& T_world_camera) {
    const Eigen::Vector3d middle = T_world_camera.inverse() * box.T_world_box.translation();
    double highest = std::numeric_limits<double>::max();
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d p = T_world_camera.inverse() * Corner(box, i);
        if (p.z() > kNear_m) highest = std::min(highest, p.y() / p.z());
    }
    return T_world_camera * Eigen::Vector3d(middle.x(), highest * middle.z(), middle.z());
}

}  // namespace

void DrawBoxes(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
               const RenderStyle& style, ColourImage& image) {
    std::vector<const NamedBox*> far_first;
    for (const NamedBox& box : style.boxes) far_first.push_back(&box);
    std::ranges::stable_sort(far_first, std::greater{}, [&](const NamedBox* box) {
        return (T_world_camera.inverse() * box->T_world_box.translation()).z();
    });
    Pen pen(camera, T_world_camera, image);
    for (const NamedBox* box : far_first)
        for (int i = 0; i < 8; ++i)
            for (const int axis : {1, 2, 4})
                if ((i & axis) == 0) pen.Line(Corner(*box, i), Corner(*box, i | axis), box->colour);
    for (const NamedBox* box : far_first)
        if (!box->name.empty()) pen.Write(NamePlace(*box, T_world_camera), box->name, box->colour);
}

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
