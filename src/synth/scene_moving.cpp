// Scenes with motion: people who walk through a room, a chair that is moved, a door that opens.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/builtin_scenes.h"
#include "synth/interiors.h"
#include "synth/paint.h"
#include "synth/walker.h"

namespace tessera {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kTurn_s = 24;  // period of the camera's loop

// 0 before `from_s`, 1 after `to_s`, smooth in between.
double Progress(double time_s, double from_s, double to_s) {
    const double x = std::clamp((time_s - from_s) / (to_s - from_s), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

Vector3d TurningEye(double t) {
    const double a = 2 * std::numbers::pi * t / kTurn_s;
    return {2.45 - 0.75 * std::cos(a), 2.0 - 0.55 * std::sin(a), 1.45 + 0.08 * std::sin(3 * a)};
}

double TurningHeading(double t) {
    const double a = 2 * std::numbers::pi * t / kTurn_s;
    return a + 0.25 * std::sin(2 * a);
}

// A walk to and fro in front of the camera, at the given distance and angle to its heading, limited
// to the area free of furniture.
Walk WalkInFrontOfCamera(std::function<double(double)> distance_m,
                         std::function<double(double)> angle) {
    return [=](double t) {
        const double direction = TurningHeading(t) + angle(t);
        const Vector3d eye = TurningEye(t);
        const Vector2d at =
            eye.head<2>() + distance_m(t) * Vector2d(std::cos(direction), std::sin(direction));
        return Vector2d(std::clamp(at.x(), 1.1, 4.0), std::clamp(at.y(), 0.9, 3.0));
    };
}

// Stands still for three seconds, then catches up.
double WithPause(double t) {
    constexpr double kStop_s = 10, kGo_s = 13, kCatchUp = 1.5;
    if (t < kStop_s) return t;
    return t < kGo_s ? kStop_s : std::min(kStop_s + kCatchUp * (t - kGo_s), t);
}

StagedScene Stage(std::unique_ptr<AnalyticScene> scene, const Lighting& lighting,
                  const char* description, CameraPath path) {
    scene->Finish(lighting);
    StagedScene staged;
    staged.scene = std::move(scene);
    staged.description = description;
    staged.path = std::move(path);
    return staged;
}

// A camera that stays in place and looks around a little.
CameraPath Standing(const Vector3d& eye, const Vector3d& target, double duration_s) {
    CameraPath path;
    path.duration_s = duration_s;
    path.T_world_camera = [=](double t) {
        const Vector3d sway(0.18 * std::sin(0.9 * t), 0.14 * std::sin(0.7 * t + 1),
                            0.05 * std::sin(1.1 * t));
        const Vector3d look(0.35 * std::sin(0.6 * t), 0.5 * std::sin(0.8 * t),
                            0.12 * std::sin(0.5 * t + 2));
        return Eigen::Isometry3d(LookAt(eye + sway, target + look) * Tremor(t));
    };
    return path;
}

}  // namespace

StagedScene MakePeople() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    AddRoom(add);
    const auto near = [](double t) { return 1.05 + 0.3 * std::sin(0.71 * t + 0.4); };
    const auto far = [](double t) { return 1.75 + 0.35 * std::sin(0.47 * t); };
    AddWalker(*scene, "person 1",
              WalkInFrontOfCamera(near, [](double t) { return -0.85 * std::cos(0.83 * t); }),
              {170, 60, 60}, {50, 60, 96}, 701);
    const Walk second =
        WalkInFrontOfCamera(far, [](double t) { return -1.1 * std::cos(0.61 * t); });
    AddWalker(
        *scene, "person 2", [second](double t) { return second(WithPause(t)); }, {60, 120, 90},
        {70, 66, 60}, 711);
    CameraPath path;
    path.duration_s = kTurn_s;
    path.T_world_camera = [](double t) {
        const double a = 2 * std::numbers::pi * t / kTurn_s, look = TurningHeading(t);
        const Vector3d ahead(std::cos(look), std::sin(look), -0.28 + 0.10 * std::sin(2 * a + 0.5));
        return Eigen::Isometry3d(LookAt(TurningEye(t), TurningEye(t) + ahead) * Tremor(t));
    };
    return Stage(std::move(scene), RoomLighting(),
                 "two people walk about in a furnished room, one stands for a while",
                 std::move(path));
}

StagedScene MakeChair() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    AddRoom(add);
    scene->BeginMotion([](double t) {
        const double way = Progress(t, 5, 7.5);
        return Eigen::Isometry3d(StandAt(2.7 + 1.0 * way, 2.9 - 1.1 * way, 0.013, 150 + 60 * way));
    });
    add.Chair(Eigen::Isometry3d::Identity(), "chair 3", {70, 130, 90}, 721);
    scene->BeginMotion({});
    return Stage(std::move(scene), RoomLighting(),
                 "a chair in a furnished room is moved and stays there",
                 Standing({1.35, 1.1, 1.5}, {3.2, 2.4, 0.55}, 14));
}

StagedScene MakeDoor() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    AddFlat(add);
    const Paint wood = add.Repeat(PaintWood({150, 104, 66}, 3, 512, 731), 0.8);
    scene->BeginMotion([](double t) {
        return Eigen::Isometry3d(StandAt(6.95, 1.8, 0.005, -75 * Progress(t, 4, 6)));
    });
    add.Box(Eigen::Isometry3d::Identity(), {0, -0.5, 0}, {0.04, 1.0, 2.04}, wood);
    scene->BeginMotion({});
    return Stage(std::move(scene), FlatLighting(), "a door between two furnished rooms opens",
                 Standing({4.2, 1.6, 1.45}, {7.0, 1.7, 1.05}, 12));
}

}  // namespace tessera
