#include "synth/model_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera {
namespace {

using Eigen::Vector3d;
constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kLargestThing = 2.5;  // metres; larger models are entered, not circled
constexpr double kEyeHeight = 1.4;     // metres above the lowest point of the model
constexpr double kSpeed = 0.35;        // m/s

struct Axes {
    Vector3d right, ahead, up;
    Vector3d Direction(double angle) const {
        return std::cos(angle) * right + std::sin(angle) * ahead;
    }
};

// Distance of the nearest surface around `eye`; 0 if many directions are open, as outdoors, or if
// there is no floor.
double Clearance(const Scene& scene, const Axes& axes, const Vector3d& eye) {
    constexpr int kRays = 24;
    double nearest = std::numeric_limits<double>::infinity();
    int open = 0;
    for (int i = 0; i < kRays; ++i) {
        const SurfaceHit hit = scene.CastRay(eye, axes.Direction(kTwoPi * i / kRays));
        if (!hit.valid()) ++open;
        nearest = std::min(nearest, hit.t);
    }
    const bool floor_below = scene.CastRay(eye, -axes.up).valid();
    return open > kRays / 4 || !floor_below ? 0.0 : std::min(nearest, 1.5);
}

Vector3d RoomiestPlace(const Scene& scene, const Axes& axes, double height) {
    constexpr int kGrid = 24;
    const Eigen::AlignedBox3d& bounds = scene.bounds();
    Vector3d best = bounds.center();
    best += (height - best.dot(axes.up)) * axes.up;
    double most = -1;
    for (int i = 0; i < kGrid; ++i) {
        for (int j = 0; j < kGrid; ++j) {
            const Vector3d share((i + 0.5) / kGrid - 0.5, (j + 0.5) / kGrid - 0.5, 0);
            const Vector3d size = bounds.sizes();
            Vector3d p = bounds.center() +
                         share.x() * size.dot(axes.right.cwiseAbs()) * axes.right +
                         share.y() * size.dot(axes.ahead.cwiseAbs()) * axes.ahead;
            p += (height - p.dot(axes.up)) * axes.up;
            if (const double clearance = Clearance(scene, axes, p); clearance > most)
                most = clearance, best = p;
        }
    }
    return best;
}

}  // namespace

CameraPath MakeModelPath(const Scene& scene, const Vector3d& up) {
    Axes axes;
    axes.up = up;
    axes.right = up.x() > 0.5 ? Vector3d::UnitY() : Vector3d::UnitX();
    axes.ahead = up.cross(axes.right);
    const Vector3d size = scene.bounds().sizes(), centre = scene.bounds().center();
    CameraPath path;
    if (size.maxCoeff() < kLargestThing) {
        const double radius = 0.5 + 0.8 * size.norm();
        path.duration_s = kTwoPi * radius / kSpeed;
        path.T_world_camera = [=](double t) {
            const double a = kTwoPi * t / (kTwoPi * radius / kSpeed);
            const Vector3d eye = centre + radius * axes.Direction(a) +
                                 radius * (0.35 + 0.15 * std::sin(2 * a)) * axes.up;
            return Eigen::Isometry3d(LookAt(eye, centre, axes.up) * Tremor(t));
        };
        return path;
    }
    const double low = scene.bounds().min().dot(up), tall = size.dot(up);
    const Vector3d place = RoomiestPlace(scene, axes, low + std::min(kEyeHeight, 0.6 * tall));
    path.duration_s = 24;
    path.T_world_camera = [=](double t) {
        const double a = kTwoPi * t / 24;
        const Vector3d eye = place - 0.3 * axes.Direction(a);
        const Vector3d ahead =
            axes.Direction(a + 0.25 * std::sin(2 * a)) + (-0.3 + 0.1 * std::sin(3 * a)) * axes.up;
        return Eigen::Isometry3d(LookAt(eye, eye + ahead, axes.up) * Tremor(t));
    };
    return path;
}

}  // namespace tessera
