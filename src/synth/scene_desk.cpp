// A desk in the corner of a room.
#include <cmath>
#include <numbers>

#include "synth/builtin_scenes.h"
#include "synth/furniture.h"
#include "synth/paint.h"

namespace tessera {
namespace {

constexpr double kTop = 0.74;  // height of the desk, metres

void FurnishSurroundings(Furnisher& add) {
    const Paint floor = add.Repeat(PaintWood({150, 108, 70}, 8, 1024, 21), 1.6);
    const Paint wall = add.Repeat(PaintNoise({214, 208, 192}, 34, 1024, 22), 1.7);
    const Paint side = add.Repeat(PaintStripes({196, 208, 206}, {168, 186, 188}, 1024, 23), 1.3);
    const Eigen::Isometry3d origin = StandAt(0, 0, 0);
    add.Box(origin, {0.6, -1.6, -0.1}, {5.0, 4.0, 0.1}, floor);
    add.Box(origin, {0.6, 0.45, 0}, {5.0, 0.1, 2.6}, wall);
    add.Box(origin, {-1.35, -1.6, 0}, {0.1, 4.0, 2.6}, side);
    const Eigen::Isometry3d back = StandAt(0, 0.4, 0);
    const Eigen::Isometry3d left = StandAt(-1.3, 0, 0, 90);
    add.Poster(back, -0.62, 1.62, 0.50, 0.66, "Haute Route", 41);
    add.Poster(back, 0.62, 1.60, 0.74, 0.52, "Night at the harbour", 42);
    add.Poster(left, -0.75, 1.55, 0.60, 0.80, "Observatory", 43);
    add.Table(StandAt(0, 0, 0), {1.7, 0.78, kTop},
              add.Repeat(PaintWood({186, 138, 88}, 3, 1024, 24), 1.1), "");
    add.Box(StandAt(0.60, 0.05, 0), {0, 0, 0}, {0.40, 0.55, 0.60}, add.Flat({206, 206, 202}));
}

void FurnishDesk(Furnisher& add) {
    add.Monitor(StandAt(-0.32, 0.16, kTop, 12), "monitor 1", 51);
    add.Monitor(StandAt(0.27, 0.18, kTop, -8), "monitor 2", 52);
    add.Keyboard(StandAt(-0.14, -0.19, kTop, 3), "keyboard 1");
    add.Laptop(StandAt(0.58, -0.10, kTop, -24), "laptop 1", 53);
    add.Cup(StandAt(-0.50, -0.16, kTop, -35), "cup 1", {232, 228, 216}, {44, 92, 160});
    add.Cup(StandAt(0.22, -0.27, kTop, 20), "cup 2", {190, 62, 48}, {245, 232, 200});
    add.Book(StandAt(-0.68, -0.06, kTop, 8), "Dense Mapping", {0.19, 0.26, 0.034}, {36, 84, 120});
    add.Book(StandAt(-0.69, -0.05, kTop + 0.034, -6), "Signed Distance", {0.18, 0.24, 0.028},
             {150, 44, 40});
    add.Book(StandAt(-0.67, -0.06, kTop + 0.062, 14), "Of Cameras", {0.15, 0.21, 0.022},
             {210, 160, 56});
    add.Book(StandAt(0.30, -0.05, kTop, -32), "Field Notes", {0.15, 0.21, 0.018}, {58, 110, 78});
    add.Book(StandAt(-0.36, -0.31, kTop, -12), "Robust Methods", {0.17, 0.12, 0.020},
             {92, 60, 116});
    add.Box(StandAt(0.16, -0.19, kTop, 5), {0, 0, 0}, {0.06, 0.105, 0.030}, add.Flat({70, 70, 76}));
    add.Box(StandAt(-0.02, -0.33, kTop, -7), {0, 0, 0}, {0.21, 0.10, 0.003},
            add.Fit(PaintPage(420, 200, 55)));
    add.Lamp(StandAt(-0.74, 0.24, kTop));
}

}  // namespace

StagedScene MakeDesk() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    FurnishSurroundings(add);
    FurnishDesk(add);
    Lighting lighting;
    lighting.lights = {{{0.9, -1.3, 2.5}, 0.30, 3.1}, {{-0.9, -1.9, 2.4}, 0.25, 1.3}};
    lighting.texel_m = 0.012;
    scene->Finish(lighting);
    StagedScene staged;
    staged.scene = std::move(scene);
    staged.description = "a desk in a room's corner";
    staged.path.duration_s = 10;
    staged.path.T_world_camera = [](double t) {
        const double a = 2 * std::numbers::pi * t / 10;
        const Eigen::Vector3d eye(0.05 + 0.42 * std::sin(a), -1.22 + 0.16 * std::cos(2 * a + 0.4),
                                  1.36 + 0.10 * std::sin(2 * a + 1.0));
        const Eigen::Vector3d target(-0.05 + 0.20 * std::sin(a + 0.7), 0.05,
                                     0.84 + 0.07 * std::cos(a));
        return Eigen::Isometry3d(LookAt(eye, target) * Tremor(t));
    };
    return staged;
}

}  // namespace tessera
