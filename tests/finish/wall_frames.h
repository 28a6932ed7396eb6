// Exact frames of a painted wall, the plane z = 0, which faces -z.
#pragma once

#include <cmath>

#include "core/camera.h"
#include "core/frame.h"

namespace tessera::testing_support {

inline PinholeCamera WallCamera() { return {160, 120, 150, 150, 79.5, 59.5}; }

// The paint: smooth, different in each channel.
inline Eigen::Array3f WallPaint(double x, double y) {
    return {static_cast<float>(130 + 80 * std::sin(12 * x)),
            static_cast<float>(120 + 70 * std::cos(9 * y)),
            static_cast<float>(100 + 50 * std::sin(7 * x + 5 * y))};
}

// A camera at `at` (z < 0) that looks along +z, turned by `yaw_rad` about its y axis.
inline Frame WallFrame(const Eigen::Vector3d& at, double yaw_rad,
                       const Eigen::Array3f& exposure = Eigen::Array3f::Ones()) {
    const PinholeCamera camera = WallCamera();
    Frame frame;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = at;
    T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    frame.T_world_camera = T;
    frame.colour = ColourImage(camera.width, camera.height);
    frame.depth_m = DepthImage(camera.width, camera.height);
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d ray = T.linear() * camera.Unproject(u, v, 1);
            const double scale = -at.z() / ray.z();
            const Eigen::Vector3d hit = at + scale * ray;
            const Eigen::Array3f paint = (exposure * WallPaint(hit.x(), hit.y())).min(255).max(0);
            frame.depth_m(u, v) = static_cast<float>(scale);
            frame.colour(u, v) = {static_cast<std::uint8_t>(std::lround(paint[0])),
                                  static_cast<std::uint8_t>(std::lround(paint[1])),
                                  static_cast<std::uint8_t>(std::lround(paint[2]))};
        }
    return frame;
}

}  // namespace tessera::testing_support
