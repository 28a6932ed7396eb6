// A wall behind a grid of bright squares, seen without noise by a shaky camera whose colour is of
// another time.
#pragma once

#include <cmath>
#include <utility>

#include "core/camera.h"
#include "core/frame.h"

namespace tessera::squares_view {

inline const PinholeCamera kCamera{320, 240, 270, 270, 159.5, 119.5};

inline Eigen::Isometry3d Pose(double t) {
    return Eigen::Isometry3d(
        Eigen::Translation3d(0.05 * std::sin(2 * t), 0.03 * std::cos(3 * t), 0) *
        Eigen::AngleAxisd(0.2 * std::sin(3 * t), Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(0.12 * std::sin(4 * t + 1), Eigen::Vector3d::UnitX()));
}

// The depth of a pixel at time t, and whether it shows a square.
inline std::pair<double, bool> Seen(double t, int u, int v) {
    constexpr double kSquares_m = 1.5, kWall_m = 3, kPeriod_m = 0.5;
    const Eigen::Isometry3d T = Pose(t);
    const Eigen::Vector3d ray = T.linear() * kCamera.Unproject(u, v, 1);
    const double near_m = (kSquares_m - T.translation().z()) / ray.z();
    const Eigen::Vector3d p = T.translation() + near_m * ray;
    const auto inside = [](double x) { return x - kPeriod_m * std::floor(x / kPeriod_m) < 0.25; };
    if (inside(p.x()) && inside(p.y())) return {near_m, true};
    return {(kWall_m - T.translation().z()) / ray.z(), false};
}

// Depth is of time t, colour of `delay_s` later, in rows that take `readout_s`. Both stamps are t.
inline Frame View(double t, double delay_s, double readout_s = 0) {
    Frame frame;
    frame.stamp_s = frame.colour_stamp_s = t;
    frame.depth_m.Resize(kCamera.width, kCamera.height);
    frame.colour.Resize(kCamera.width, kCamera.height);
    for (int v = 0; v < kCamera.height; ++v) {
        const double colour_s = t + delay_s + readout_s * ((v + 0.5) / kCamera.height - 0.5);
        for (int u = 0; u < kCamera.width; ++u) {
            frame.depth_m(u, v) = static_cast<float>(Seen(t, u, v).first);
            frame.colour(u, v) =
                Seen(colour_s, u, v).second ? Rgb8{200, 160, 140} : Rgb8{60, 70, 80};
        }
    }
    return frame;
}

}  // namespace tessera::squares_view
