// A painted box-shaped room, seen without noise by a rotating camera.
#pragma once

#include <cmath>

#include "core/camera.h"
#include "core/frame.h"

namespace tessera::painted_room {

inline const PinholeCamera kCamera{320, 240, 270, 270, 159.5, 119.5};
inline const Eigen::Vector3d kHalfRoom(2.0, 1.3, 2.4);

inline double Paint(const Eigen::Vector3d& p) {
    return 0.5 + 0.16 * std::sin(9 * p.x() + 2 * p.z()) * std::sin(8 * p.y() + 1) +
           0.14 * std::sin(7 * p.z() - 5 * p.y()) +
           0.12 * std::sin(15 * p.x() - 4 * p.y() + 11 * p.z());
}

// A pixel of an image of 320 x 240 whose corners are darker by the share `vignetting`.
inline Rgb8 GreyAt(int u, int v, double brightness, double vignetting) {
    const double dx = (u - 159.5) / 159.5, dy = (v - 119.5) / 119.5;
    const double left = 1 - vignetting * (0.64 * dx * dx + 0.36 * dy * dy);
    const auto grey = static_cast<std::uint8_t>(std::lround(255 * left * brightness));
    return {grey, grey, grey};
}

// A frame on a slow, shaky path that starts near the origin and rotates about all axes. The corners
// are darker by the share `vignetting`.
inline Frame View(int number, double readout_s, double vignetting = 0) {
    const auto pose = [](double t) {
        return Eigen::Isometry3d(
            Eigen::Translation3d(0.1 * std::sin(t), 0.05 * std::cos(1.7 * t),
                                 0.1 * std::sin(0.8 * t)) *
            Eigen::AngleAxisd(0.35 * std::sin(0.9 * t), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(0.25 * std::sin(1.4 * t + 0.5), Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(0.15 * std::sin(0.6 * t), Eigen::Vector3d::UnitZ()));
    };
    Frame frame;
    frame.stamp_s = frame.colour_stamp_s = 0.1 * number;
    frame.colour.Resize(kCamera.width, kCamera.height);
    frame.depth_m.Resize(kCamera.width, kCamera.height);
    for (int v = 0; v < kCamera.height; ++v) {
        const Eigen::Isometry3d T = pose(frame.stamp_s + readout_s * (v / 240.0 - 0.5));
        for (int u = 0; u < kCamera.width; ++u) {
            const Eigen::Vector3d ray = T.linear() * kCamera.Unproject(u, v, 1);
            double z = 1e9;
            for (int k = 0; k < 3; ++k)
                z = std::min(
                    z, ((ray(k) > 0 ? kHalfRoom(k) : -kHalfRoom(k)) - T.translation()(k)) / ray(k));
            frame.colour(u, v) = GreyAt(u, v, Paint(T.translation() + z * ray), vignetting);
            frame.depth_m(u, v) = static_cast<float>(z);
        }
    }
    return frame;
}

}  // namespace tessera::painted_room
