// A furnished room, and a corridor of 40 m.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/builtin_scenes.h"
#include "synth/interiors.h"
#include "synth/paint.h"

namespace tessera {
namespace {

void FurnishRoomWalls(Furnisher& add) {
    const Eigen::Isometry3d north = StandAt(0, 4, 0), south = StandAt(0, 0, 0, 180);
    const Eigen::Isometry3d west = StandAt(0, 0, 0, 90), east = StandAt(5, 0, 0, -90);
    add.Poster(north, 1.2, 1.7, 0.9, 0.65, "Ridge walk", 61);
    add.Poster(north, 3.6, 1.7, 0.6, 0.8, "Lighthouse", 62);
    add.Poster(south, -1.0, 1.65, 0.8, 0.6, "Old town", 63);
    add.Poster(west, 1.2, 1.6, 0.7, 0.9, "Botany", 64);
    add.Poster(west, 2.9, 1.7, 0.8, 0.55, "Estuary", 65);
    add.Poster(east, -1.3, 1.65, 1.0, 0.7, "Winter sun", 66);
    add.Door(south, -3.9, "12", {150, 100, 66});
}

void FurnishRoom(Furnisher& add) {
    const Paint oak = add.Repeat(PaintWood({172, 124, 78}, 3, 512, 71), 0.9);
    add.Table(StandAt(1.0, 3.4, 0), {1.5, 0.7, 0.74}, oak, "table 1");
    add.Monitor(StandAt(1.0, 3.55, 0.74, -6), "monitor 1", 72);
    add.Keyboard(StandAt(0.95, 3.22, 0.74, 4), "keyboard 1");
    add.Cup(StandAt(1.45, 3.25, 0.74, 40), "cup 1", {232, 228, 216}, {44, 120, 90});
    add.Book(StandAt(0.45, 3.3, 0.74, 20), "Atlas", {0.24, 0.3, 0.03}, {40, 70, 120});
    add.Chair(StandAt(1.1, 2.75, 0, 195), "chair 1", {60, 92, 140}, 73);
    add.Chair(StandAt(4.4, 2.9, 0, -70), "chair 2", {150, 60, 50}, 74);
    add.Shelf(StandAt(2.9, 3.84, 0), "shelf 1", 3);
    add.Shelf(StandAt(4.84, 1.2, 0, -90), "shelf 2", 5);
    const Paint cloth = add.Repeat(PaintStripes({110, 128, 104}, {168, 172, 140}, 512, 75), 0.6);
    const Eigen::Isometry3d sofa = StandAt(0.5, 1.3, 0, 90);
    add.Box(sofa, {0, 0, 0}, {1.7, 0.8, 0.42}, cloth);
    add.Box(sofa, {0, 0.33, 0.42}, {1.7, 0.18, 0.40}, cloth);
    for (const double x : {-0.78, 0.78}) add.Box(sofa, {x, 0, 0.42}, {0.16, 0.8, 0.18}, cloth);
    add.Box(StandAt(2.4, 0.28, 0), {0, 0, 0}, {1.2, 0.45, 0.7},
            add.Repeat(PaintWood({120, 80, 52}, 4, 512, 76), 0.7));
    add.Laptop(StandAt(2.2, 0.30, 0.7, 170), "laptop 1", 77);
    add.Lamp(StandAt(2.8, 0.28, 0.7));
    add.Sphere(StandAt(3.9, 0.7, 0), {0, 0, 0}, 0.19,
               add.Repeat(PaintChecker({230, 90, 50}, {245, 240, 225}, 6, 6, 252), 0.5969));
    add.Cylinder(StandAt(4.6, 3.7, 0), {0, 0, 0}, 0.16, 0.35,
                 add.Repeat(PaintTiles({176, 110, 76}, {120, 70, 50}, 4, 256, 78), 0.3351));
    add.Sphere(StandAt(4.6, 3.7, 0), {0, 0, 0.32}, 0.28,
               add.Repeat(PaintNoise({64, 112, 58}, 120, 256, 79), 0.5864));
    add.Box(StandAt(2.4, 2.0, 0, 8), {0, 0, 0}, {1.9, 1.3, 0.012},
            add.Repeat(PaintTiles({142, 60, 52}, {220, 200, 160}, 6, 512, 80), 0.9));
}

void FurnishCorridor(Furnisher& add, double length, double width) {
    const Eigen::Isometry3d left = StandAt(0, width, 0), right = StandAt(0, 0, 0, 180);
    const Rgb8 doors[] = {{150, 100, 66}, {92, 112, 130}, {132, 70, 60}, {112, 126, 92}};
    for (int i = 0; i < 8; ++i) {
        const double x = 2.6 + 5.0 * i, other = x + 2.3;
        const std::string number = std::to_string(101 + 2 * i);
        add.Door(left, x, number, doors[i % 4]);
        if (other < length - 1)
            add.Door(right, -other, std::to_string(102 + 2 * i), doors[(i + 1) % 4]);
        const auto seed = static_cast<std::uint64_t>(200 + 10 * i);
        add.Poster(left, x + 1.5, 1.6, 0.7, 0.9, "Gallery " + number, seed);
        add.Poster(left, x + 2.7, 1.65, 0.9, 0.6, "Plan " + number, seed + 1);
        add.Poster(right, -(x + 0.4), 1.6, 0.8, 0.8, "Notice " + number, seed + 2);
        const double pillar = x - 1.2;
        add.Box(StandAt(pillar, width - 0.11, 0), {0, 0, 0}, {0.34, 0.22, 2.6},
                add.Repeat(PaintNoise({178, 170, 156}, 70, 256, seed + 3), 0.6));
        add.Box(StandAt(pillar, 0.11, 0), {0, 0, 0}, {0.34, 0.22, 2.6},
                add.Repeat(PaintNoise({178, 170, 156}, 70, 256, seed + 4), 0.6));
        if (i % 2 == 0)
            add.Chair(StandAt(x + 1.3, width - 0.32, 0, 4.0 * i), "chair " + std::to_string(i + 1),
                      doors[(i + 2) % 4], seed + 5);
        else
            add.Box(StandAt(x + 0.3, 0.22, 0, 0), {0, 0, 0}, {0.5, 0.4, 0.9},
                    add.Repeat(PaintWood({130, 96, 62}, 3, 256, seed + 6), 0.5));
    }
    add.Poster(StandAt(length, 0, 0, -90), -width / 2, 1.6, 1.2, 0.9, "Way out", 301);
    add.Poster(StandAt(0, 0, 0, 90), width / 2, 1.6, 1.2, 0.9, "Level 1", 302);
}

}  // namespace

void AddRoom(Furnisher& add) {
    add.Shell({5, 4, 2.6}, add.Repeat(PaintWood({152, 112, 74}, 8, 1024, 81), 1.6),
              add.Repeat(PaintNoise({226, 224, 216}, 22, 512, 82), 2.0),
              add.Repeat(PaintStripes({212, 200, 176}, {182, 172, 150}, 1024, 83), 1.6));
    FurnishRoomWalls(add);
    FurnishRoom(add);
}

Lighting RoomLighting() {
    Lighting lighting;
    lighting.lights = {
        {{2.5, 2.0, 2.4}, 0.25, 2.7}, {{0.8, 3.0, 2.3}, 0.2, 1.0}, {{4.2, 1.0, 2.3}, 0.2, 1.0}};
    lighting.texel_m = 0.03;
    return lighting;
}

StagedScene MakeRoom() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    AddRoom(add);
    scene->Finish(RoomLighting());
    StagedScene staged;
    staged.scene = std::move(scene);
    staged.description = "a furnished room of 5 m x 4 m, one closed turn";
    staged.path.duration_s = 24;
    staged.path.T_world_camera = [](double t) {
        const double a = 2 * std::numbers::pi * t / 24;
        // Circles around the middle, looking across it and outwards, moving up and down a little.
        const Eigen::Vector3d eye(2.45 - 0.75 * std::cos(a), 2.0 - 0.55 * std::sin(a),
                                  1.45 + 0.08 * std::sin(3 * a));
        const double look = a + 0.25 * std::sin(2 * a);
        const Eigen::Vector3d target = eye + Eigen::Vector3d(std::cos(look), std::sin(look),
                                                             -0.28 + 0.10 * std::sin(2 * a + 0.5));
        return Eigen::Isometry3d(LookAt(eye, target) * Tremor(t));
    };
    return staged;
}

StagedScene MakeCorridor() {
    constexpr double kLength = 40, kWidth = 2.2, kWalk = 37, kDuration = 88;
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    add.Shell({kLength, kWidth, 2.6},
              add.Repeat(PaintTiles({168, 160, 148}, {96, 92, 88}, 6, 1024, 91), 2.4),
              add.Repeat(PaintTiles({222, 222, 218}, {190, 190, 188}, 4, 512, 92), 2.4),
              add.Repeat(PaintNoise({204, 202, 186}, 64, 1024, 93), 2.9));
    FurnishCorridor(add, kLength, kWidth);
    Lighting lighting;
    for (int i = 0; i < 10; ++i)
        lighting.lights.push_back({{2.0 + 4.0 * i, kWidth / 2, 2.5}, 0.2, 1.35});
    lighting.texel_m = 0.06;
    scene->Finish(lighting);
    StagedScene staged;
    staged.scene = std::move(scene);
    staged.description = "a corridor of 40 m, walked from end to end";
    staged.path.duration_s = kDuration;
    staged.path.T_world_camera = [](double t) {
        // Constant pace. After the end the camera walks back, so that any number of frames can be
        // rendered.
        const double lap = std::abs(std::remainder(t, 2 * kDuration)) / kDuration;
        const Eigen::Vector3d eye(1.0 + kWalk * lap, kWidth / 2 + 0.25 * std::sin(0.31 * t),
                                  1.45 + 0.03 * std::sin(2 * std::numbers::pi * 0.45 * t));
        const double yaw = 0.42 * std::sin(0.45 * t), pitch = -0.16 + 0.08 * std::sin(0.37 * t + 1);
        const Eigen::Vector3d ahead(std::cos(yaw), std::sin(yaw), pitch);
        return Eigen::Isometry3d(LookAt(eye, eye + ahead) * Tremor(t));
    };
    return staged;
}

}  // namespace tessera
