// Scenes that are difficult for trackers: texture without structure, structure without texture, and
// neither.
#include <cmath>
#include <numbers>

#include "synth/builtin_scenes.h"
#include "synth/furniture.h"
#include "synth/paint.h"

namespace tessera {
namespace {

// Hand-held sweeps within `reach_m` of `eye`, with the view following around `target`.
CameraPath Sweep(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                 const Eigen::Vector3d& reach_m, const Eigen::Vector3d& up) {
    CameraPath path;
    path.duration_s = 10;
    path.T_world_camera = [=](double t) {
        const double a = 2 * std::numbers::pi * t / 10;
        const Eigen::Vector3d wave(std::sin(a), std::sin(2 * a + 0.6), std::sin(2 * a + 2.0));
        const Eigen::Vector3d moved = eye + reach_m.cwiseProduct(wave);
        const Eigen::Vector3d looked =
            target + 0.7 * reach_m.cwiseProduct(Eigen::Vector3d(std::sin(a + 0.3), wave.y(), 0));
        return Eigen::Isometry3d(LookAt(moved, looked, up) * Tremor(t));
    };
    return path;
}

// Constant light, so that each face has one brightness.
std::unique_ptr<AnalyticScene> FinishEven(std::unique_ptr<AnalyticScene> scene) {
    Lighting lighting;
    lighting.baked = false;
    scene->Finish(lighting);
    return scene;
}

}  // namespace

StagedScene MakeFloor() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    // A second, slower pattern makes the tiles distinguishable.
    add.Box(StandAt(0, 0, 0), {0, 0, -0.1}, {8, 8, 0.1},
            add.Repeat(PaintTiles({176, 150, 118}, {84, 74, 66}, 12, 1536, 95), 3.6));
    StagedScene staged;
    staged.scene = FinishEven(std::move(scene));
    staged.description = "a patterned floor: texture without structure";
    staged.path =
        Sweep({0, -0.5, 1.25}, {0, 0.25, 0}, {0.45, 0.25, 0.12}, Eigen::Vector3d::UnitZ());
    return staged;
}

StagedScene MakeCorner() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    const Paint white = add.Flat({232, 230, 226});
    add.Box(StandAt(0, 0, 0), {2, -2, -0.1}, {4.2, 4.2, 0.1}, white);
    add.Box(StandAt(0, 0, 0), {2, 0.05, 0}, {4.2, 0.1, 3}, white);
    add.Box(StandAt(0, 0, 0), {-0.05, -2, 0}, {0.1, 4.0, 3}, white);
    StagedScene staged;
    staged.scene = FinishEven(std::move(scene));
    staged.description = "three bare bright walls: structure without texture";
    staged.path = Sweep({1.35, -1.45, 1.25}, {0.1, -0.15, 0.45}, {0.25, 0.25, 0.18},
                        Eigen::Vector3d::UnitZ());
    return staged;
}

StagedScene MakeWall() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    add.Box(StandAt(0, 0, 0), {0, 0.05, -1}, {9, 0.1, 5}, add.Flat({226, 222, 214}));
    StagedScene staged;
    staged.scene = FinishEven(std::move(scene));
    staged.description = "one bare wall: neither structure nor texture";
    staged.path = Sweep({0, -1.5, 1.4}, {0, 0, 1.4}, {0.4, 0.2, 0.15}, Eigen::Vector3d::UnitZ());
    return staged;
}

}  // namespace tessera
