#include "synth/walker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/paint.h"

namespace tessera {
namespace {

using Eigen::Vector3d;
constexpr double kStepsPerSecond = 1.9, kFullSwing = 0.45;  // at 1 m/s; radians
constexpr double kHip_m = 0.88, kShoulder_m = 1.40;

Eigen::Vector2d Velocity(const Walk& walk, double time_s) {
    constexpr double kReach_s = 0.3;  // bodies turn slowly
    return (walk(time_s + kReach_s) - walk(time_s - kReach_s)) / (2 * kReach_s);
}

// Upright, with the front (-y) in the walking direction; along x when standing.
Eigen::Isometry3d T_world_feet(const Walk& walk, double time_s) {
    const Eigen::Vector2d ahead = Velocity(walk, time_s) + Eigen::Vector2d(0.02, 0);
    const Eigen::Vector2d at = walk(time_s);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Vector3d(at.x(), at.y(), 0);
    T.linear() = Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()) + std::numbers::pi / 2,
                                   Vector3d::UnitZ())
                     .toRotationMatrix();
    return T;
}

// A limb that hangs from a joint at height `joint_m` and swings with the walk. `phase`: 0 or pi.
AnalyticScene::Motion Swing(const Walk& walk, double joint_m, double share, double phase) {
    return [=](double time_s) {
        const double pace = std::min(Velocity(walk, time_s).norm(), 1.0);
        const double angle = share * kFullSwing * pace *
                             std::sin(std::numbers::pi * kStepsPerSecond * time_s + phase);
        const Vector3d joint(0, 0, joint_m);
        return Eigen::Isometry3d(T_world_feet(walk, time_s) * Eigen::Translation3d(joint) *
                                 Eigen::AngleAxisd(angle, Vector3d::UnitX()) *
                                 Eigen::Translation3d(-joint));
    };
}

}  // namespace

void AddWalker(AnalyticScene& scene, const std::string& name, const Walk& walk, Rgb8 shirt,
               Rgb8 trousers, std::uint64_t seed) {
    Furnisher add(scene);
    const Paint cloth = add.Repeat(PaintStripes(shirt, {235, 230, 215}, 256, seed), 0.22);
    const Paint denim = add.Repeat(PaintNoise(trousers, 50, 256, seed + 1), 0.3);
    const Paint skin = add.Repeat(PaintNoise({214, 170, 140}, 24, 128, seed + 2), 0.2);
    const Paint leather = add.Flat({50, 40, 34});
    const Eigen::Isometry3d feet = Eigen::Isometry3d::Identity();
    scene.BeginInstance(name, "person");
    scene.BeginMotion([walk](double time_s) { return T_world_feet(walk, time_s); });
    add.Box(feet, {0, 0, 0.84}, {0.38, 0.22, 0.60}, cloth);
    add.Cylinder(feet, {0, 0, 1.44}, 0.055, 0.10, skin);
    add.Sphere(feet, {0, 0, 1.51}, 0.115, skin);
    for (const int side : {-1, 1}) {
        const double phase = side < 0 ? 0 : std::numbers::pi;
        scene.BeginMotion(Swing(walk, kHip_m, 1, phase));
        add.Cylinder(feet, {0.10 * side, 0, 0.06}, 0.075, 0.82, denim);
        add.Box(feet, {0.10 * side, -0.05, 0.01}, {0.10, 0.26, 0.07}, leather);
        scene.BeginMotion(Swing(walk, kShoulder_m, 0.8, phase + std::numbers::pi));
        add.Cylinder(feet, {0.245 * side, 0, 0.85}, 0.048, 0.57, cloth);
        add.Sphere(feet, {0.245 * side, 0, 0.78}, 0.05, skin);
    }
    scene.BeginMotion({});
    scene.BeginInstance("", "");
}

}  // namespace tessera
