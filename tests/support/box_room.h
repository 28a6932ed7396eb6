// A synthetic scene with an exact solution: the inside of a box with a smooth texture and,
// optionally, a ball. Renders depth and colour, and returns the exact signed distance.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/camera.h"
#include "core/frame.h"
#include "core/se3.h"

namespace tessera::testing_support {

inline PinholeCamera SmallCamera() { return {160, 120, 131.0, 131.0, 79.5, 59.5}; }

struct BoxRoom {
    Eigen::Vector3d low{-1.3, -0.9, -1.0}, high{1.1, 0.8, 1.9};  // metres
    bool has_ball = false;
    Eigen::Vector3d ball_centre{0.2, 0.1, 1.2};
    double ball_radius_m = 0.3;
    double texture = 1.0;         // contrast; 0 gives a room of one colour
    bool only_back_wall = false;  // only the plane z = high.z()

    // Positive in the free space inside the room.
    double SignedDistance(const Eigen::Vector3d& p) const {
        if (only_back_wall) return high.z() - p.z();
        double d = std::min((p - low).minCoeff(), (high - p).minCoeff());
        if (has_ball) d = std::min(d, (p - ball_centre).norm() - ball_radius_m);
        return d;
    }

    // Smooth in space, with wavelengths of 15 to 60 cm.
    double Intensity(const Eigen::Vector3d& p) const {
        const double wave = std::sin(23 * p.x() + 11 * p.y()) +
                            std::sin(-9 * p.x() + 31 * p.y() + 13 * p.z()) +
                            std::sin(27 * p.z() + 17 * p.y() - 5 * p.x());
        return 0.5 + texture * 0.13 * wave;
    }

    // Distance along `ray` (any length) from `origin`, in units of the ray's length. Both are in
    // the world frame.
    double Cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const {
        double nearest = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            if (only_back_wall && axis != 2) continue;
            for (const double wall : {low(axis), high(axis)}) {
                if (only_back_wall && wall == low(axis)) continue;
                const double t = (wall - origin(axis)) / ray(axis);
                if (t > 1e-9) nearest = std::min(nearest, t);
            }
        }
        if (has_ball) {
            const Eigen::Vector3d o = origin - ball_centre;
            const double a = ray.squaredNorm(), b = o.dot(ray),
                         c = o.squaredNorm() - ball_radius_m * ball_radius_m;
            if (const double root = b * b - a * c; root > 0) {
                const double t = (-b - std::sqrt(root)) / a;
                if (t > 1e-9) nearest = std::min(nearest, t);
            }
        }
        return nearest;
    }

    Frame Render(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                 double stamp_s = 0) const {
        Frame frame;
        frame.stamp_s = frame.colour_stamp_s = stamp_s;
        frame.colour = ColourImage(camera.width, camera.height);
        frame.depth_m = DepthImage(camera.width, camera.height);
        frame.T_world_camera = T_world_camera;
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d ray = T_world_camera.linear() * camera.Unproject(u, v, 1.0);
                const double z = Cast(T_world_camera.translation(), ray);
                if (!std::isfinite(z)) continue;
                frame.depth_m(u, v) = static_cast<float>(z);
                const double i = Intensity(T_world_camera.translation() + z * ray);
                const auto grey =
                    static_cast<std::uint8_t>(std::clamp(255.0 * i + 0.5, 0.0, 255.0));
                frame.colour(u, v) = {grey, grey, grey};
            }
        return frame;
    }
};

// Pose i of a camera at 30 Hz on a smooth path that rotates about and moves along every axis.
inline Eigen::Isometry3d SmoothPath(int i, double speed = 1.0) {
    const double t = speed * i / 30.0;
    Vector6d twist;
    twist << 0.08 * std::sin(1.1 * t), 0.12 * std::sin(0.9 * t), 0.06 * std::sin(1.3 * t),
        0.15 * std::sin(1.0 * t), 0.08 * std::sin(1.4 * t), 0.10 * std::sin(0.8 * t);
    return Se3Exp(twist);
}

}  // namespace tessera::testing_support
