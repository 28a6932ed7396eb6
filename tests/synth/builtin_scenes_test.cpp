#include "synth/builtin_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "synth/frame_renderer.h"

namespace tessera {
namespace {

TEST(BuiltinScenes, AnUnknownNameListsTheKnownOnes) {
    const auto scene = MakeBuiltinScene("kitchen");
    ASSERT_FALSE(scene.ok());
    EXPECT_EQ(scene.message(),
              "'kitchen' is not a built-in scene; use one of desk, room, flat, walk, corridor, "
              "floor, corner, "
              "wall, people, chair, door, or give an .obj file");
}

TEST(BuiltinScenes, TheDeskHasItsObjects) {
    const auto desk = MakeBuiltinScene("desk");
    ASSERT_TRUE(desk.ok());
    const Scene& scene = *desk.value().scene;
    std::multiset<std::string> classes;
    for (const SceneInstance& instance : scene.instances())
        classes.insert(scene.class_names()[instance.class_id]);
    EXPECT_EQ(classes.count("computer"), 2u);
    EXPECT_EQ(classes.count("cup"), 2u);
    EXPECT_EQ(classes.count("keyboard"), 1u);
    EXPECT_EQ(classes.count("laptop"), 1u);
    EXPECT_GE(classes.count("book"), 3u);
}

// The camera moves at the speed of a hand and keeps clear of the scene.
TEST(BuiltinScenes, MotionsAreSmoothAndKeepClearOfTheScene) {
    for (const char* name : {"desk", "floor", "corner", "wall", "corridor", "flat"}) {
        const auto staged = MakeBuiltinScene(name);
        ASSERT_TRUE(staged.ok());
        const CameraPath& path = staged.value().path;
        Eigen::Isometry3d last = path.T_world_camera(0);
        double fastest = 0, fastest_turn = 0;
        constexpr double kStep = 1.0 / 30;
        for (double t = kStep; t < path.duration_s; t += kStep) {
            const Eigen::Isometry3d T = path.T_world_camera(t);
            fastest = std::max(fastest, (T.translation() - last.translation()).norm() / kStep);
            fastest_turn = std::max(fastest_turn, RotationAngle(last, T) / kStep);
            EXPECT_GT(*staged.value().scene->SignedDistance(T.translation()), 0.2)
                << name << " at " << t;
            last = T;
        }
        EXPECT_LT(fastest, 0.62) << name;
        EXPECT_GT(fastest, 0.1) << name;
        EXPECT_LT(fastest_turn, 40 * std::numbers::pi / 180) << name;
    }
}

// Three rounds through the flat: the camera comes back to where it began at three different times,
// twice in the direction in which it left.
TEST(BuiltinScenes, TheWalkReturnsThreeTimes) {
    const auto walk = MakeBuiltinScene("walk");
    ASSERT_TRUE(walk.ok());
    const CameraPath& path = walk.value().path;
    constexpr double kStep = 1.0 / 30;
    const Eigen::Isometry3d first = path.T_world_camera(0);
    Eigen::Isometry3d last = first;
    double length_m = 0, away_since_m = 0;
    int returns = 0;
    for (double t = kStep; t < path.duration_s; t += kStep) {
        const Eigen::Isometry3d T = path.T_world_camera(t);
        const double step_m = (T.translation() - last.translation()).norm();
        length_m += step_m;
        EXPECT_LT(step_m / kStep, 0.95) << t;
        EXPECT_LT(RotationAngle(last, T) / kStep, 100 * std::numbers::pi / 180) << t;
        EXPECT_GT(*walk.value().scene->SignedDistance(T.translation()), 0.2) << t;
        last = T;
        if ((T.translation() - first.translation()).head<2>().norm() > 2.5) {
            away_since_m += step_m;
        } else if (away_since_m > 15) {
            ++returns;
            away_since_m = 0;
        }
    }
    EXPECT_EQ(returns, 3);
    EXPECT_GT(length_m, 95);
    EXPECT_LT(length_m, 110);
}

TEST(BuiltinScenes, TheRoomsTurnEndsWhereItBegan) {
    const auto room = MakeBuiltinScene("room");
    ASSERT_TRUE(room.ok());
    const CameraPath& path = room.value().path;
    const Eigen::Isometry3d first = path.T_world_camera(0),
                            last = path.T_world_camera(path.duration_s);
    EXPECT_LT((first.translation() - last.translation()).norm(), 0.02);
    EXPECT_LT(RotationAngle(first, last), 0.03);
}

// The mask marks exactly the pixels that change when the moving objects are removed. The reference
// contains none of those objects.
TEST(BuiltinScenes, WhatMovesIsMaskedAndNoPartOfTheReference) {
    const auto staged = MakeBuiltinScene("people");
    ASSERT_TRUE(staged.ok());
    const Scene& scene = *staged.value().scene;
    EXPECT_TRUE(scene.has_motion());
    const PinholeCamera camera{160, 120, 131, 131, 79.5, 59.5};
    double most = 0;
    for (const double t : {0.0, 3.0, 8.0, 11.5, 16.0, 22.0}) {
        const Eigen::Isometry3d T = staged.value().path.T_world_camera(t);
        RenderedView view;
        FrameRenderer(scene, camera).Render(staged.value().path, t, 0, view, true);
        std::int64_t masked = 0;
        for (int y = 0; y < camera.height; y += 3)
            for (int x = 0; x < camera.width; x += 3) {
                const bool moves = view.mobility(x, y) != Mobility::kStatic;
                masked += moves;
                const SurfaceHit behind =
                    scene.CastRay(T.translation(), T.linear() * camera.Unproject(x, y, 1));
                ASSERT_EQ(view.patch(x, y) < 0, moves);
                if (moves)
                    EXPECT_LT(view.depth_m(x, y), behind.t);
                else
                    EXPECT_NEAR(view.depth_m(x, y), behind.t, 1e-5);
            }
        most = std::max(most, static_cast<double>(masked) / (40 * 54));
    }
    EXPECT_GT(most, 0.2);
}

TEST(BuiltinScenes, TheChairRestsMovesAndRests) {
    const auto staged = MakeBuiltinScene("chair");
    ASSERT_TRUE(staged.ok());
    const PinholeCamera camera{160, 120, 131, 131, 79.5, 59.5};
    for (const auto& [t, expected] : {std::pair{2.0, Mobility::kResting},
                                      {6.0, Mobility::kMoving},
                                      {10.0, Mobility::kResting}}) {
        RenderedView view;
        FrameRenderer(*staged.value().scene, camera).Render(staged.value().path, t, 0, view);
        const auto count =
            std::count(view.mobility.data(), view.mobility.data() + view.mobility.size(), expected);
        const auto rest = std::count(
            view.mobility.data(), view.mobility.data() + view.mobility.size(), Mobility::kStatic);
        EXPECT_GT(count, 200) << t;
        EXPECT_EQ(count + rest, 160 * 120) << t;
    }
}

TEST(BuiltinScenes, ThePlainScenesAreAsPlainAsTheySay) {
    for (const char* name : {"corner", "wall"}) {
        const auto staged = MakeBuiltinScene(name);
        ASSERT_TRUE(staged.ok());
        const Scene& scene = *staged.value().scene;
        const Eigen::Isometry3d T = staged.value().path.T_world_camera(1.0);
        std::set<float> greys;
        for (int i = 0; i < 400; ++i) {
            const Eigen::Vector3d d((i % 20 - 9.5) / 20, (i / 20 - 9.5) / 26, 1);
            const SurfaceHit hit = scene.CastRay(T.translation(), T.linear() * d);
            ASSERT_TRUE(hit.valid()) << name;
            greys.insert(scene.Colour(hit, 0.002f).g);
        }
        EXPECT_EQ(greys.size(), name == std::string("corner") ? 3u : 1u) << name;
    }
}

}  // namespace
}  // namespace tessera
