#include "synth/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/trajectory.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

TEST(LookAt, ZPassesThroughTheTargetAndYPointsDown) {
    const Eigen::Isometry3d T = LookAt({1, 2, 3}, {4, 6, 3});
    EXPECT_NEAR((T * Eigen::Vector3d(0, 0, 5) - Eigen::Vector3d(4, 6, 3)).norm(), 0, 1e-12);
    EXPECT_NEAR((T.linear() * Eigen::Vector3d::UnitY() - Eigen::Vector3d(0, 0, -1)).norm(), 0,
                1e-12);
    EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
    // With a view from the south towards the north-east, right is south-east.
    EXPECT_NEAR((T.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d(0.8, -0.6, 0)).norm(), 0,
                1e-12);
}

TEST(Tremor, IsAHandsSize) {
    double shift2 = 0, angle2 = 0;
    constexpr int kSteps = 3000;
    for (int i = 0; i < kSteps; ++i) {
        const Eigen::Isometry3d T = Tremor(i / 30.0);
        shift2 += T.translation().squaredNorm() / kSteps;
        angle2 += std::pow(RotationAngle(Eigen::Isometry3d::Identity(), T), 2) / kSteps;
    }
    EXPECT_GT(std::sqrt(shift2), 0.001);
    EXPECT_LT(std::sqrt(shift2), 0.003);
    EXPECT_NEAR(std::sqrt(angle2) * 180 / std::numbers::pi, 0.3, 0.15);
}

class RecordedPath : public testing::Test {
  protected:
    void SetUp() override {
        poses_ = {{10.0, LookAt({0, -1, 1}, {0, 0, 1})},
                  {10.5, LookAt({0.2, -1, 1}, {0.2, 0, 1})},
                  {11.0, LookAt({0.2, -0.8, 1.1}, {0.3, 0, 1})}};
        ASSERT_TRUE(WriteTrajectory(file_, poses_).ok());
    }
    std::string file_ = ProcessFolder() + "/recorded_path.txt";
    std::vector<StampedPose> poses_;
};

TEST_F(RecordedPath, PassesThroughItsPosesAndStopsAtItsEnds) {
    const Result<CameraPath> path = ReadCameraPath(file_);
    ASSERT_TRUE(path.ok()) << path.message();
    EXPECT_NEAR(path.value().duration_s, 1.0, 1e-6);
    for (const StampedPose& pose : poses_)
        EXPECT_TRUE(
            path.value().T_world_camera(pose.stamp_s - 10).isApprox(pose.T_world_camera, 1e-6));
    EXPECT_NEAR(path.value().T_world_camera(0.25).translation().x(), 0.1, 1e-6);
    EXPECT_TRUE(path.value().T_world_camera(5).isApprox(poses_.back().T_world_camera, 1e-6));
}

TEST_F(RecordedPath, MovedToAStartKeepsItsRelativeMotion) {
    const Eigen::Isometry3d T_world_start = LookAt({5, 5, 5}, {5, 4, 4});
    const Result<CameraPath> path = ReadCameraPath(file_, &T_world_start);
    ASSERT_TRUE(path.ok());
    EXPECT_TRUE(path.value().T_world_camera(0).isApprox(T_world_start, 1e-6));
    const Eigen::Isometry3d expected =
        poses_[0].T_world_camera.inverse() * poses_[2].T_world_camera;
    EXPECT_TRUE(
        (T_world_start.inverse() * path.value().T_world_camera(1)).isApprox(expected, 1e-6));
}

TEST(CameraPath, ErrorsNameTheFile) {
    EXPECT_NE(ReadCameraPath("/nowhere/path.txt").message().find("/nowhere/path.txt"),
              std::string::npos);
    const std::string single = ProcessFolder() + "/single_pose.txt";
    ASSERT_TRUE(WriteTrajectory(single, {{1.0, Eigen::Isometry3d::Identity()}}).ok());
    EXPECT_EQ(ReadCameraPath(single).message(),
              single + ": needs at least two poses to move along");
}

}  // namespace
}  // namespace tessera
