// Exact views of a room's corner with a ball in it, or of its far wall, painted with smooth waves.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/frame_motion.h"
#include "core/se3.h"
#include "optimize/dense_view.h"

namespace tessera::view_test {

inline const PinholeCamera kViewCamera{640, 480, 525, 525, 319.5, 239.5};

// A room's corner with a ball in it, painted with smooth waves; exact. World: the first camera.
inline double DepthAlong(const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
    double nearest = 1e9;
    const auto plane = [&](const Eigen::Vector3d& normal, double offset) {
        const double t = (offset - normal.dot(from)) / normal.dot(along);
        if (t > 0) nearest = std::min(nearest, t);
    };
    plane({0, 0, 1}, 2.5);
    plane({1, 0, 0.2}, 1.6);
    plane({0, 1, 0.1}, 1.2);
    const Eigen::Vector3d to_ball = from - Eigen::Vector3d(-0.3, 0.1, 1.9);
    const double b = to_ball.dot(along), c = to_ball.squaredNorm() - 0.35 * 0.35;
    const double a = along.squaredNorm(), root = b * b - a * c;
    if (root > 0) nearest = std::min(nearest, (-b - std::sqrt(root)) / a);
    return nearest;
}

inline double Paint(const Eigen::Vector3d& p) {
    return 0.5 + 0.2 * std::sin(9 * p.x() + 3 * p.z()) + 0.2 * std::sin(8 * p.y() - 2 * p.x());
}

// The walls are the far one only.
enum class Scene { kCorner, kBareWall, kPaintedWall };

// A frame of a camera that moves: each row of colour is of its own time.
inline PreparedFrame FrameOf(const Eigen::Isometry3d& T_world_camera, Scene scene,
                             const std::function<double(const Eigen::Vector3d&)>& paint,
                             const FrameMotion& motion) {
    PreparedFrame frame;
    frame.width = kViewCamera.width;
    frame.height = kViewCamera.height;
    frame.has_colour = true;
    frame.depth_m.Resize(frame.width, frame.height);
    frame.intensity.Resize(frame.width, frame.height);
    struct Hit {
        double z;
        Eigen::Vector3d p_world;
    };
    const auto hit = [&](const Eigen::Isometry3d& T, int x, int y) {
        const Eigen::Vector3d ray = T.linear() * kViewCamera.Unproject(x, y, 1);
        const Eigen::Vector3d eye = T.translation();
        const double z = scene == Scene::kCorner ? DepthAlong(eye, ray) : (2.5 - eye.z()) / ray.z();
        return Hit{z, eye + z * ray};
    };
    const bool still = motion.twist_per_s.isZero();
    for (int y = 0; y < frame.height; ++y) {
        const Eigen::Isometry3d T_world_colour =
            T_world_camera * Se3Exp(motion.ColourTime(y, frame.height) * motion.twist_per_s);
        for (int x = 0; x < frame.width; ++x) {
            const Hit measured = hit(T_world_camera, x, y),
                      seen = still ? measured : hit(T_world_colour, x, y);
            frame.depth_m(x, y) = static_cast<float>(measured.z);
            frame.intensity(x, y) =
                static_cast<float>(scene == Scene::kBareWall ? 0.5 : paint(seen.p_world));
        }
    }
    return frame;
}

inline ReducedView ReducedFrom(const Eigen::Isometry3d& T_world_camera, Scene scene,
                               const std::function<double(const Eigen::Vector3d&)>& paint) {
    return MakeReducedView(FrameOf(T_world_camera, scene, paint, {}), kViewCamera, {});
}

// `gain`: of the light.
inline ReducedView ReducedFrom(const Eigen::Isometry3d& T_world_camera,
                               Scene scene = Scene::kCorner, double gain = 1) {
    return ReducedFrom(T_world_camera, scene,
                       [=](const Eigen::Vector3d& p) { return gain * Paint(p); });
}

inline DenseView ViewFrom(const Eigen::Isometry3d& T_world_camera, Scene scene = Scene::kCorner,
                          double gain = 1) {
    return MakeDenseView(ReducedFrom(T_world_camera, scene, gain), kViewCamera);
}

inline Eigen::Isometry3d Moved(double turn, double shift) {
    Vector6d twist;
    twist << 0.3 * turn, turn, -0.2 * turn, shift, 0.4 * shift, -0.5 * shift;
    return Se3Exp(twist);
}

}  // namespace tessera::view_test
