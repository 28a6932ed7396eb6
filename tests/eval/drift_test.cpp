#include "eval/drift.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "eval/test_trajectories.h"

namespace tessera {
namespace {

// An estimate that is one per cent too long and turns by 0.1 degrees a metre.
TEST(Drift, GrowsWithTheDistanceInClosedForm) {
    constexpr double kTurn = 0.1 * std::numbers::pi / 180;
    std::vector<StampedPose> reference, longer, turning;
    for (int i = 0; i <= 1500; ++i) {
        const double x = 0.02 * i, t = i / 30.0;
        reference.push_back(PoseAt(t, {x, 0, 0}));
        longer.push_back(PoseAt(t, {1.01 * x, 0, 0}));
        turning.push_back(reference.back());
        turning.back().T_world_camera.linear() =
            Eigen::AngleAxisd(kTurn * x, Eigen::Vector3d::UnitX()).toRotationMatrix();
    }
    const auto of_longer = EvaluateDrift(reference, longer);
    ASSERT_TRUE(of_longer.ok()) << of_longer.message();
    EXPECT_NEAR(of_longer.value().path_m, 30, 1e-9);
    ASSERT_EQ(of_longer.value().over_distance.size(), 5u);  // 1, 2, 5, 10, 20 m
    for (const DriftResult::OverDistance& d : of_longer.value().over_distance) {
        EXPECT_NEAR(d.trans_fraction, 0.01, 2e-4) << d.distance_m;  // steps of 2 cm
        EXPECT_NEAR(d.rot_rad_per_m, 0, 1e-9);
    }
    EXPECT_EQ(of_longer.value().over_distance[3].distance_m, 10);
    EXPECT_NEAR(static_cast<double>(of_longer.value().over_distance[3].pairs), 1001, 2);
    EXPECT_TRUE(of_longer.value().revisits.empty());
    const auto of_turning = EvaluateDrift(reference, turning);
    for (const DriftResult::OverDistance& d : of_turning.value().over_distance)
        EXPECT_NEAR(d.rot_rad_per_m, kTurn, 0.02 * kTurn) << d.distance_m;
    const auto json = nlohmann::json::parse(DriftJson(of_longer.value()));
    EXPECT_NEAR(json.at("over_distance").at(0).at("trans_percent").get<double>(), 1, 0.03);
    EXPECT_EQ(json.at("revisits").at("count"), 0);
}

// Two rounds of 20 m. In the second, the estimate is 3 cm too high.
TEST(Drift, ShowsWhereTheCameraReturns) {
    std::vector<StampedPose> reference, estimate;
    for (int i = 0; i < 2000; ++i) {
        const double angle = 2 * std::numbers::pi * i / 1000, radius = 20 / (2 * std::numbers::pi);
        const Eigen::Vector3d p(radius * std::cos(angle), radius * std::sin(angle), 0);
        reference.push_back(PoseAt(i / 30.0, p));
        estimate.push_back(PoseAt(i / 30.0, p + Eigen::Vector3d(0, 0, i < 1000 ? 0 : 0.03)));
    }
    const auto drift = EvaluateDrift(reference, estimate);
    ASSERT_TRUE(drift.ok()) << drift.message();
    // One every 10 cm or a little more: the poses are 2 cm apart.
    EXPECT_NEAR(static_cast<double>(drift.value().revisits.size()), 180, 20);
    for (const DriftResult::Revisit& revisit : drift.value().revisits) {
        if (revisit.again_s < 1000 / 30.0) continue;  // the end of the first round is its beginning
        EXPECT_NEAR(revisit.trans_m, 0.03, 1e-9);
        EXPECT_NEAR(revisit.again_s - revisit.first_s, 1000 / 30.0, 0.5);
    }
    EXPECT_NEAR(drift.value().revisit_m.max, 0.03, 1e-9);
    EXPECT_NEAR(drift.value().revisit_rad.rmse, 0, 1e-9);
}

TEST(Drift, WithoutPosesAtTheSameTimeItIsAnError) {
    const std::vector<StampedPose> reference = {PoseAt(0, {0, 0, 0}), PoseAt(1, {1, 0, 0})};
    EXPECT_FALSE(EvaluateDrift(reference, {PoseAt(5, {0, 0, 0})}).ok());
    EXPECT_FALSE(EvaluateDrift({}, {}).ok());
    EXPECT_FALSE(PlotCorrection(reference, reference, {PoseAt(5, {0, 0, 0})}, "none").ok());
}

TEST(Drift, ThePictureHasBothPaths) {
    const auto reference = WindingPath(100);
    auto tracked = reference;
    for (std::size_t i = 0; i < tracked.size(); ++i)
        tracked[i].T_world_camera.translation().y() += 0.002 * static_cast<double>(i);
    const auto picture = PlotCorrection(reference, tracked, reference, "test");
    ASSERT_TRUE(picture.ok()) << picture.message();
    int grey = 0, red = 0, blue = 0;
    for (std::size_t i = 0; i < picture.value().size(); ++i) {
        const Rgb8 c = picture.value().data()[i];
        grey += c == Rgb8{150, 154, 160};
        red += c == Rgb8{255, 0, 0};
        blue += c.b == 255 && c.r == 0 && c.g < 60;
    }
    EXPECT_GT(grey, 100);
    EXPECT_GT(red, 5);  // the end, which was corrected most
    EXPECT_GT(blue, 5);
}

}  // namespace
}  // namespace tessera
