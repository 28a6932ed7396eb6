#include "export/level.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace tessera {
namespace {

// A rectangle of vertices 2 cm apart, with noise of 3 mm and normals with noise of 5 degrees.
void AddRectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                  std::mt19937& random, TriangleMesh& mesh) {
    std::normal_distribution<double> off(0, 0.003), tilt(0, 5 * std::numbers::pi / 180);
    const Eigen::Vector3d normal = u.cross(v).normalized();
    const int rows = static_cast<int>(u.norm() / 0.02), columns = static_cast<int>(v.norm() / 0.02);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            mesh.vertices.push_back(
                (corner + u * i / rows + v * j / columns + off(random) * normal).cast<float>());
            mesh.normals.push_back(
                (normal + tilt(random) * u.normalized() + tilt(random) * v.normalized())
                    .normalized()
                    .cast<float>());
        }
}

// A room of 4 m x 3 m with a table of 1 m x 1 m, z up, floor at z = 0.
TriangleMesh LevelRoom(bool floor) {
    std::mt19937 random(7);
    TriangleMesh mesh;
    if (floor) {
        AddRectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, random, mesh);
        AddRectangle({1, 1, 0.75}, {1, 0, 0}, {0, 1, 0}, random, mesh);
    }
    AddRectangle({0, 3, 0}, {4, 0, 0}, {0, 0, 2.5}, random, mesh);
    AddRectangle({0, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, random, mesh);
    return mesh;
}

// Cameras at 1.4 m that look along +y, 20 degrees down, and sway by 30 degrees.
std::vector<StampedPose> Walk() {
    std::vector<StampedPose> path;
    for (int i = 0; i < 60; ++i) {
        StampedPose pose;
        pose.stamp_s = i;
        Eigen::Matrix3d R;
        R << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // x right, y down, z ahead
        const double sway = 0.5 * std::sin(0.7 * i), down = -20 * std::numbers::pi / 180;
        pose.T_world_camera.linear() = Eigen::AngleAxisd(sway, Eigen::Vector3d::UnitZ()) * R *
                                       Eigen::AngleAxisd(down, Eigen::Vector3d::UnitX());
        pose.T_world_camera.translation() = Eigen::Vector3d(1.5 + 0.01 * i, 0.8, 1.4);
        path.push_back(pose);
    }
    return path;
}

// The world of a run is its first camera's.
void IntoCameraWorld(TriangleMesh& mesh, std::vector<StampedPose>& path) {
    const Eigen::Isometry3d T = path.front().T_world_camera.inverse();
    for (Eigen::Vector3f& p : mesh.vertices) p = T.cast<float>() * p;
    for (Eigen::Vector3f& n : mesh.normals) n = T.cast<float>().linear() * n;
    for (StampedPose& pose : path) pose.T_world_camera = T * pose.T_world_camera;
}

TEST(Level, FindsUpFloorAndHeadingOfARoomSeenByATiltedCamera) {
    TriangleMesh mesh = LevelRoom(true);
    const TriangleMesh truth = mesh;
    std::vector<StampedPose> path = Walk();
    const Eigen::Vector3d first = path.front().T_world_camera.translation();
    IntoCameraWorld(mesh, path);
    const Result<Level> level = FindLevel(mesh, path);
    ASSERT_TRUE(level.ok()) << level.message();
    EXPECT_NEAR(level.value().tilt_rad, 20 * std::numbers::pi / 180, 0.001);
    EXPECT_NEAR(level.value().roughness_m, 0.003, 0.0005);
    MakeLevel(level.value(), mesh, path);
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 97) {
        const Eigen::Vector3d expected =
            truth.vertices[i].cast<double>() - Eigen::Vector3d(first.x(), first.y(), 0);
        EXPECT_LT((mesh.vertices[i].cast<double>() - expected).norm(), 0.005) << i;
        EXPECT_LT((mesh.normals[i] - truth.normals[i]).norm(), 0.003) << i;
    }
    EXPECT_LT((path.front().T_world_camera.translation() - Eigen::Vector3d(0, 0, 1.4)).norm(),
              0.002);
    const TriangleMesh y_down = WithYDown(mesh);
    EXPECT_EQ(y_down.vertices[5].y(), -mesh.vertices[5].z());
    EXPECT_EQ(y_down.normals[5].z(), mesh.normals[5].y());
}

// A phone is held sideways, to the left or to the right.
TEST(Level, FindsUpHoweverTheCameraWasHeld) {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    for (const int roll : {0, 90, -90}) {
        TriangleMesh mesh = LevelRoom(true);
        std::vector<StampedPose> path;
        for (const StampedPose& pose : Walk()) {
            Eigen::Matrix3d R;
            R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
            path.push_back(pose);
            path.back().T_world_camera.linear() =
                AngleAxisd(0.1 * pose.stamp_s, Vector3d::UnitZ()) * R *
                AngleAxisd(-20 * std::numbers::pi / 180, Vector3d::UnitX()) *
                AngleAxisd(roll * std::numbers::pi / 180, Vector3d::UnitZ());
        }
        IntoCameraWorld(mesh, path);
        const Result<Level> level = FindLevel(mesh, path);
        ASSERT_TRUE(level.ok()) << level.message() << roll;
        MakeLevel(level.value(), mesh, path);
        for (const StampedPose& pose : path)
            EXPECT_NEAR(pose.T_world_camera.translation().z(), 1.4, 0.003) << roll;
    }
}

// The ceiling is the largest surface and gives the vertical; it is not parallel to the floor. The
// world begins far from the room.
TEST(Level, TheFloorUnderTheFirstCameraIsAtZero) {
    constexpr double kTilt = 0.5 * std::numbers::pi / 180, kFar_m = 20;
    std::mt19937 random(7);
    TriangleMesh mesh;
    AddRectangle({kFar_m + 0.5, 0, 0}, {2.5, 0, 0}, {0, 2, 0}, random, mesh);
    AddRectangle({kFar_m, 0, 2.5}, {0, 3, 0}, {4 * std::cos(kTilt), 0, 4 * std::sin(kTilt)}, random,
                 mesh);
    std::vector<StampedPose> path = Walk();
    for (StampedPose& pose : path) pose.T_world_camera.pretranslate(Eigen::Vector3d(kFar_m, 0, 0));
    const Result<Level> level = FindLevel(mesh, path);
    ASSERT_TRUE(level.ok()) << level.message();
    const Eigen::Vector3d z = level.value().T_level_world.linear().row(2);
    EXPECT_NEAR(z.x(), -std::sin(kTilt), 0.001);
    MakeLevel(level.value(), mesh, path);
    EXPECT_NEAR(path.front().T_world_camera.translation().z(), 1.4, 0.003);
}

// Its image's lower edge is ahead where it looks straight up, the upper one where straight down.
TEST(Level, ACameraThatLooksStraightUpOrDownHasAHeading) {
    for (const bool up : {true, false}) {
        TriangleMesh mesh = LevelRoom(true);
        std::vector<StampedPose> path = Walk();
        Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  // y, down in the image, is ahead
        if (!up) R.diagonal() << 1, -1, -1;
        path.front().T_world_camera.linear() = R;
        const Result<Level> level = FindLevel(mesh, path);
        ASSERT_TRUE(level.ok()) << level.message();
        MakeLevel(level.value(), mesh, path);
        EXPECT_LT((path.front().T_world_camera.linear() - R).norm(), 0.01) << up;
    }
}

TEST(Level, WhereThereIsNoFloorItIsAnError) {
    TriangleMesh mesh = LevelRoom(false);
    std::vector<StampedPose> path = Walk();
    EXPECT_NE(FindLevel(mesh, path).message().find("horizontal"), std::string::npos);
    mesh = LevelRoom(true);
    EXPECT_NE(FindLevel(mesh, {}).message().find("which way is up"), std::string::npos);
    for (std::size_t i = 0; i < path.size(); ++i)  // turned about the view, all around
        path[i].T_world_camera.rotate(Eigen::AngleAxisd(
            2 * std::numbers::pi * static_cast<double>(i) / 60, Eigen::Vector3d::UnitZ()));
    EXPECT_NE(FindLevel(mesh, path).message().find("which way is up"), std::string::npos);
    mesh.normals.clear();
    EXPECT_NE(FindLevel(mesh, Walk()).message().find("normals"), std::string::npos);
}

}  // namespace
}  // namespace tessera
