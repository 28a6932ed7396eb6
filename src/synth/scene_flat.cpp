// Two furnished rooms joined by two doorways: a closed tour of 30 m.
#include <cmath>
#include <numbers>

#include "synth/builtin_scenes.h"
#include "synth/interiors.h"
#include "synth/paint.h"

namespace tessera {
namespace {

// Metres. The wall between the rooms is in the middle.
constexpr double kLength = 14, kWidth = 6, kHeight = 2.6, kWall = 7;

void BuildPartition(Furnisher& add, const Paint& wall) {
    const double doors[][2] = {{0.8, 1.8}, {4.2, 5.2}};
    double from = 0;
    for (const auto& door : doors) {
        add.Box(StandAt(kWall, (from + door[0]) / 2, 0), {0, 0, 0}, {0.16, door[0] - from, kHeight},
                wall);
        add.Box(StandAt(kWall, (door[0] + door[1]) / 2, 0), {0, 0, 2.05},
                {0.16, door[1] - door[0], kHeight - 2.05}, wall);
        from = door[1];
    }
    add.Box(StandAt(kWall, (from + kWidth) / 2, 0), {0, 0, 0}, {0.16, kWidth - from, kHeight},
            wall);
}

void FurnishFlatWalls(Furnisher& add) {
    const Eigen::Isometry3d north = StandAt(0, kWidth, 0), south = StandAt(0, 0, 0, 180);
    const Eigen::Isometry3d west = StandAt(0, 0, 0, 90), east = StandAt(kLength, 0, 0, -90);
    const Eigen::Isometry3d left_of_wall = StandAt(kWall - 0.08, 0, 0, -90),
                            right_of_wall = StandAt(kWall + 0.08, 0, 0, 90);
    const char* captions[] = {"Harbour", "Glacier", "Orchard", "Viaduct",
                              "Meteors", "Foundry", "Canal",   "Dunes"};
    for (int i = 0; i < 8; ++i) {
        const double x = 1.1 + 1.7 * i;
        const auto seed = static_cast<std::uint64_t>(400 + 7 * i);
        add.Poster(north, x, 1.6 + 0.1 * (i % 3), 0.6 + 0.1 * (i % 4), 0.8 - 0.1 * (i % 3),
                   captions[i], seed);
        add.Poster(south, -x - 0.5, 1.65 - 0.1 * (i % 2), 0.9 - 0.1 * (i % 3), 0.6 + 0.1 * (i % 2),
                   captions[7 - i], seed + 1);
    }
    add.Poster(west, 2.0, 1.6, 0.8, 1.0, "North wing", 471);
    add.Poster(west, 4.2, 1.7, 1.1, 0.7, "Tide table", 472);
    add.Poster(east, -1.8, 1.7, 1.0, 0.8, "South wing", 473);
    add.Poster(east, -4.0, 1.6, 0.7, 0.9, "Star map", 474);
    add.Poster(left_of_wall, -3.0, 1.6, 1.2, 0.9, "Room one", 475);
    add.Poster(right_of_wall, 3.0, 1.6, 1.3, 0.8, "Room two", 476);
    add.Door(west, 3.1, "1", {150, 100, 66});
    add.Door(east, -2.9, "2", {92, 112, 130});
}

void FurnishFirstRoom(Furnisher& add) {
    const Paint oak = add.Repeat(PaintWood({172, 124, 78}, 3, 512, 481), 0.9);
    add.Table(StandAt(4.4, 3.0, 0, 12), {1.6, 0.8, 0.74}, oak, "table 1");
    add.Monitor(StandAt(4.3, 3.1, 0.74, 8), "monitor 1", 482);
    add.Keyboard(StandAt(4.45, 2.78, 0.74, 14), "keyboard 1");
    add.Cup(StandAt(4.95, 3.0, 0.74, 40), "cup 1", {232, 228, 216}, {44, 120, 90});
    add.Book(StandAt(3.85, 2.9, 0.74, 20), "Atlas", {0.24, 0.3, 0.03}, {40, 70, 120});
    add.Chair(StandAt(5.5, 3.2, 0, -60), "chair 1", {60, 92, 140}, 483);
    add.Shelf(StandAt(1.6, 5.8, 0), "shelf 1", 484);
    add.Shelf(StandAt(4.9, 5.8, 0), "shelf 2", 485);
    add.Shelf(StandAt(3.4, 0.2, 0, 180), "shelf 3", 486);
    const Paint cloth = add.Repeat(PaintStripes({110, 128, 104}, {168, 172, 140}, 512, 487), 0.6);
    add.Box(StandAt(0.45, 3.0, 0, 90), {0, 0, 0}, {1.7, 0.7, 0.42}, cloth);
    add.Box(StandAt(0.2, 3.0, 0, 90), {0, 0, 0.42}, {1.7, 0.2, 0.4}, cloth);
    add.Cylinder(StandAt(6.4, 0.35, 0), {0, 0, 0}, 0.2, 0.6,
                 add.Repeat(PaintTiles({176, 110, 76}, {120, 70, 50}, 4, 256, 488), 0.33));
}

void FurnishSecondRoom(Furnisher& add) {
    const Paint walnut = add.Repeat(PaintWood({112, 76, 52}, 4, 512, 491), 0.8);
    add.Table(StandAt(9.6, 3.0, 0, -8), {1.8, 0.9, 0.74}, walnut, "table 2");
    add.Laptop(StandAt(9.3, 3.0, 0.74, 20), "laptop 1", 492);
    add.Cup(StandAt(10.1, 2.9, 0.74, -30), "cup 2", {60, 90, 160}, {240, 240, 230});
    add.Book(StandAt(9.9, 3.2, 0.74, -25), "Glossary", {0.2, 0.27, 0.05}, {150, 50, 60});
    add.Lamp(StandAt(10.3, 3.25, 0.74));
    add.Chair(StandAt(8.4, 2.9, 0, 80), "chair 2", {150, 60, 50}, 493);
    add.Chair(StandAt(13.4, 5.4, 0, -140), "chair 3", {80, 130, 80}, 494);
    add.Box(StandAt(11.2, 0.3, 0), {0, 0, 0}, {1.4, 0.5, 0.8}, walnut);
    add.Sphere(StandAt(11.4, 0.3, 0.8), {0, 0, 0}, 0.17,
               add.Repeat(PaintChecker({230, 90, 50}, {245, 240, 225}, 6, 6, 252), 0.53));
    add.Shelf(StandAt(8.6, 0.2, 0, 180), "shelf 4", 495);
    add.Shelf(StandAt(10.2, 5.8, 0), "shelf 5", 496);
    add.Box(StandAt(7.6, 5.65, 0), {0, 0, 0}, {0.6, 0.5, 1.1},
            add.Repeat(PaintNoise({130, 140, 170}, 80, 256, 497), 0.5));
    add.Cylinder(StandAt(13.6, 0.4, 0), {0, 0, 0}, 0.16, 0.35,
                 add.Repeat(PaintTiles({150, 96, 70}, {90, 60, 44}, 4, 256, 498), 0.3));
    add.Sphere(StandAt(13.6, 0.4, 0), {0, 0, 0.32}, 0.28,
               add.Repeat(PaintNoise({64, 112, 58}, 120, 256, 499), 0.59));
}

// A point `path_length_m` along the loop through both doorways, and the heading there.
struct RingPoint {
    double x = 0, y = 0, heading = 0;
};
RingPoint AlongRing(double path_length_m) {
    constexpr double kLeft = 2.1, kRight = 11.9, kFront = 1.3, kBack = 4.7, kTurn = 1.2;
    constexpr double kLong = kRight - kLeft - 2 * kTurn, kShort = kBack - kFront - 2 * kTurn,
                     kArc = std::numbers::pi / 2 * kTurn;
    const double ring = 2 * (kLong + kShort) + 4 * kArc;
    double s = std::fmod(std::fmod(path_length_m, ring) + ring, ring);
    const double lengths[] = {kLong, kShort, kLong, kShort};
    RingPoint p{kLeft + kTurn, kFront, 0};
    for (const double length : lengths) {
        const double straight = std::min(s, length),
                     arc = std::min(std::max(s - length, 0.0), kArc);
        p.x += straight * std::cos(p.heading);
        p.y += straight * std::sin(p.heading);
        const double turned = p.heading + arc / kTurn;
        p.x += kTurn * (std::sin(turned) - std::sin(p.heading));
        p.y -= kTurn * (std::cos(turned) - std::cos(p.heading));
        p.heading = turned;
        s -= straight + arc;
        if (s <= 0) break;
    }
    return p;
}

}  // namespace

void AddFlat(Furnisher& add) {
    const Paint wall = add.Repeat(PaintNoise({208, 204, 190}, 60, 1024, 501), 2.6);
    add.Shell({kLength, kWidth, kHeight}, add.Repeat(PaintWood({150, 112, 76}, 8, 1024, 502), 1.6),
              add.Repeat(PaintTiles({222, 222, 218}, {190, 190, 188}, 4, 512, 503), 2.4), wall);
    BuildPartition(add, wall);
    FurnishFlatWalls(add);
    FurnishFirstRoom(add);
    FurnishSecondRoom(add);
}

Lighting FlatLighting() {
    Lighting lighting;
    for (const double x : {2.0, 5.0, 9.0, 12.0})
        for (const double y : {1.6, 4.4}) lighting.lights.push_back({{x, y, 2.5}, 0.2, 1.2});
    lighting.texel_m = 0.05;
    return lighting;
}

StagedScene MakeFlat() {
    constexpr double kDuration_s = 80, kPace_m_s = 30.0 / kDuration_s;
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    AddFlat(add);
    scene->Finish(FlatLighting());
    StagedScene staged;
    staged.scene = std::move(scene);
    staged.description = "two furnished rooms of 7 m x 6 m, once around through both doorways";
    staged.path.duration_s = kDuration_s;
    staged.path.T_world_camera = [](double t) {
        const RingPoint at = AlongRing(kPace_m_s * t);
        const Eigen::Vector3d eye(at.x, at.y, 1.45 + 0.03 * std::sin(2.8 * t));
        const double yaw = at.heading + 0.55 * std::sin(0.55 * t),
                     pitch = -0.2 + 0.1 * std::sin(0.37 * t + 1);
        return Eigen::Isometry3d(
            LookAt(eye, eye + Eigen::Vector3d(std::cos(yaw), std::sin(yaw), pitch)) * Tremor(t));
    };
    return staged;
}

}  // namespace tessera
