#include "eval/ate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "eval/test_trajectories.h"
#include "io/file.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

TEST(Ate, ARigidOffsetIsNoError) {
    const auto reference = WindingPath(300);
    const auto result = EvaluateAte(reference, Moved(reference, SomeTransform()));
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_LT(result.value().error_m.max, 1e-12);
    EXPECT_EQ(result.value().pairs.size(), 300u);
    EXPECT_EQ(result.value().tracked_fraction, 1.0);
    const Eigen::Isometry3d product = result.value().T_reference_estimate * SomeTransform();
    EXPECT_LT((product.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
}

// A circle in x, y and an error of amplitude a along z with five periods per turn. The error is
// orthogonal to every rigid motion of the circle, so the alignment cannot reduce it.
TEST(Ate, ASinusoidalErrorInClosedForm) {
    constexpr double kAmplitude_m = 0.02;
    std::vector<StampedPose> reference, estimate;
    for (int i = 0; i < 1000; ++i) {
        const double angle = 2 * std::numbers::pi * i / 1000;
        const Eigen::Vector3d p(std::cos(angle), std::sin(angle), 0);
        reference.push_back(PoseAt(i * 0.1, p));
        estimate.push_back(
            PoseAt(i * 0.1 + 0.003, p + Eigen::Vector3d(0, 0, kAmplitude_m * std::sin(5 * angle))));
    }
    const auto result = EvaluateAte(reference, Moved(estimate, SomeTransform()));
    ASSERT_TRUE(result.ok()) << result.message();
    const ErrorStatistics& error = result.value().error_m;
    EXPECT_NEAR(error.rmse, kAmplitude_m / std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(error.mean, kAmplitude_m * 2 / std::numbers::pi, 2e-6);  // sum, not integral
    EXPECT_NEAR(error.median, kAmplitude_m / std::sqrt(2.0), 1e-4);
    EXPECT_NEAR(error.max, kAmplitude_m, 1e-12);
}

// No scale is fitted, so a factor of two is an error. For positions p the residual is p - mean(p).
TEST(Ate, ScaleIsNotFitted) {
    const auto reference = WindingPath(100);
    auto estimate = reference;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (StampedPose& pose : estimate) {
        mean += pose.T_world_camera.translation() / 100;
        pose.T_world_camera.translation() *= 2;
    }
    double sum = 0;
    for (const StampedPose& pose : reference)
        sum += (pose.T_world_camera.translation() - mean).squaredNorm();
    const auto result = EvaluateAte(reference, estimate);
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().error_m.rmse, std::sqrt(sum / 100), 1e-12);
}

TEST(Ate, PairsHoldWhatIsPlotted) {
    const auto reference = WindingPath(50);
    auto estimate = reference;
    estimate[10].T_world_camera.translation().y() += 0.3;
    const auto result = EvaluateAte(reference, estimate);
    ASSERT_TRUE(result.ok());
    for (std::size_t i = 0; i < 50; ++i) {
        const AteResult::Pair& pair = result.value().pairs[i];
        EXPECT_EQ(pair.stamp_s, estimate[i].stamp_s);
        EXPECT_EQ(pair.p_reference, reference[i].T_world_camera.translation());
        EXPECT_NEAR(pair.error_m, (pair.p_estimate - pair.p_reference).norm(), 1e-15);
    }
    EXPECT_GT(result.value().pairs[10].error_m, 0.25);
}

TEST(Ate, TrackedFraction) {
    const auto reference = WindingPath(100);
    std::vector<StampedPose> estimate(reference.begin(), reference.begin() + 60);
    EXPECT_DOUBLE_EQ(EvaluateAte(reference, estimate).value().tracked_fraction, 1.0);
    EXPECT_DOUBLE_EQ(EvaluateAte(reference, estimate, {0.02, 80}).value().tracked_fraction, 0.75);
    EXPECT_TRUE(EvaluateAte(reference, estimate, {0.02, 80}).value().of_frames);
    EXPECT_FALSE(EvaluateAte(reference, estimate).value().of_frames);
    EXPECT_DOUBLE_EQ(EvaluateAte(reference, estimate, {0.02, 10}).value().tracked_fraction, 1.0);
    for (int i = 0; i < 20; ++i) estimate.push_back(PoseAt(500 + i, {0, 0, 0}));  // no reference
    EXPECT_DOUBLE_EQ(EvaluateAte(reference, estimate).value().tracked_fraction, 0.75);
}

TEST(Ate, FramesOfRunReadsTheTimingsBeside) {
    const auto folder = std::filesystem::path(ProcessFolder());
    std::filesystem::create_directories(folder);
    const std::string trajectory = (folder / "trajectory.txt").string();
    const std::string timings = (folder / "timings.json").string();
    std::filesystem::remove(timings);
    EXPECT_FALSE(FramesOfRun(trajectory).has_value());
    for (const char* text : {"", "{", "[]", "{}", R"({"frames": "many"})", R"({"frames": -3})",
                             R"({"frames": 1e400})", R"({"frames": 0})"}) {
        ASSERT_TRUE(WriteTextFile(timings, text).ok());
        EXPECT_FALSE(FramesOfRun(trajectory).has_value()) << text;
    }
    ASSERT_TRUE(WriteTextFile(timings, R"({"frames": 694, "tracked": 690})").ok());
    EXPECT_EQ(FramesOfRun(trajectory), 694);
}

TEST(Ate, JsonHasTheContractsKeys) {
    const auto reference = WindingPath(30);
    const auto json = nlohmann::json::parse(AteJson(EvaluateAte(reference, reference).value()));
    EXPECT_EQ(json.size(), 7u);
    for (const char* key : {"ate_rmse_m", "ate_mean_m", "ate_median_m", "ate_max_m"})
        EXPECT_TRUE(json.at(key).is_number_float()) << key;
    EXPECT_EQ(json.at("pairs"), 30);
    EXPECT_EQ(json.at("tracked_fraction"), 1.0);
    EXPECT_EQ(json.at("alignment"), "se3");
}

}  // namespace
}  // namespace tessera
