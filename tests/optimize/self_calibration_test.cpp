// A walk through a rendered room with a Kinect's noise, measured with a calibration that is off.
#include "optimize/self_calibration.h"

#include <random>

#include "optimize/room_walk.h"

namespace tessera {
namespace {

using testing_support::RoomCamera;
using testing_support::RoomWalk;

class SelfCalibration : public testing::Test {
  protected:
    static constexpr int kViews = 40, kStep = 9;

    SelfCalibration() : frames(RoomWalk(0, kViews, kStep)) {
        std::mt19937 random(3);
        std::normal_distribution<double> noise(0, 0.004);
        for (int i = 0; i < kViews; ++i) {
            Vector6d off;
            for (double& value : off) value = i == 0 ? 0 : noise(random);
            poses.push_back(Normalised(*frames[static_cast<std::size_t>(i)].T_world_camera * Se3Exp(off)));
            for (int before : {i - 1, i - 2, i - 4})
                if (before >= 0) edges.push_back({before, i, Eigen::Isometry3d::Identity(), 0.01, 0.01, false});
        }
        for (PoseEdge& edge : edges)
            edge.T_from_to = Normalised(poses[static_cast<std::size_t>(edge.from)].inverse() * poses[static_cast<std::size_t>(edge.to)]);
    }
    // As a sensor with this error of its disparity gives them.
    std::vector<CalibrationView> Views(double offset_per_m) const {
        std::vector<CalibrationView> views;
        for (const Frame& frame : frames) {
            DepthImage depth_m = frame.depth_m;
            for (std::size_t i = 0; i < depth_m.size(); ++i) {
                float& z = depth_m.data()[i];
                z /= 1 - static_cast<float>(offset_per_m) * z;
            }
            views.emplace_back(depth_m);
        }
        return views;
    }
    static PinholeCamera Camera(double focal_scale) { return Corrected(RoomCamera(), {1 / focal_scale, 0}); }

    std::vector<Frame> frames;
    std::vector<Eigen::Isometry3d> poses;
    std::vector<PoseEdge> edges;
};

TEST_F(SelfCalibration, FindsFocalLengthAndDisparityOffset) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const auto report = RefineCalibration(Camera(1.02), Views(0.012), edges, poses);
    ASSERT_TRUE(report.ok()) << report.message();
    const CalibrationReport& r = report.value();
    EXPECT_NEAR(r.calibration.focal_scale, 1.02, 2 * r.focal_sigma);
    EXPECT_NEAR(r.calibration.disparity_offset_per_m, 0.012, 2 * r.offset_sigma_per_m);
    EXPECT_LT(report.value().rms_after_m, 0.7 * report.value().rms_before_m);
    for (int i = 0; i < kViews; ++i) {
        const auto at = static_cast<std::size_t>(i);
        EXPECT_LT((poses[at].translation() - frames[at].T_world_camera->translation()).norm(), 0.02) << i;
    }
}

TEST_F(SelfCalibration, LeavesAGoodOneAlone) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const auto report = RefineCalibration(RoomCamera(), Views(0), edges, poses);
    ASSERT_TRUE(report.ok()) << report.message();
    const CalibrationReport& r = report.value();
    EXPECT_NEAR(r.calibration.focal_scale, 1, 2 * r.focal_sigma);
    EXPECT_NEAR(r.calibration.disparity_offset_per_m, 0, 2 * r.offset_sigma_per_m);
    EXPECT_LT(r.focal_sigma, 0.004);
    EXPECT_LT(r.offset_sigma_per_m, 0.002);
    EXPECT_NE(CalibrationText(RoomCamera(), report.value()).find("fx 26"), std::string::npos);
}

// A bare wall looks the same however it is measured.
TEST_F(SelfCalibration, SaysThatAWallDoesNotShowIt) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    DepthImage wall(320, 240);
    std::fill_n(wall.data(), wall.size(), 1.5f);
    const std::vector<CalibrationView> views(8, CalibrationView(wall));
    std::vector<PoseEdge> still;
    for (int i = 1; i < 8; ++i) still.push_back({i - 1, i, Eigen::Isometry3d::Identity(), 0.01, 0.01, false});
    std::vector<Eigen::Isometry3d> at(8, Eigen::Isometry3d::Identity());
    EXPECT_FALSE(RefineCalibration(RoomCamera(), views, still, at).ok());
    EXPECT_FALSE(RefineCalibration(RoomCamera(), {views[0]}, {}, at).ok());
}

}  // namespace
}  // namespace tessera
