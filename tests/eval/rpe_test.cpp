#include "eval/rpe.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "eval/test_trajectories.h"

namespace tessera {
namespace {

TEST(Rpe, ARigidOffsetIsNoError) {
    const auto reference = WindingPath(100);
    const auto result = EvaluateRpe(reference, Moved(reference, SomeTransform()));
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_LT(result.value().trans_m.max, 1e-12);
    EXPECT_LT(result.value().rot_rad.max, 1e-7);
    // The last 30 of the 100 poses have no pose a second later. For the 70th, that is the last pose
    // itself, which the TUM script leaves out.
    EXPECT_EQ(result.value().pairs.size(), 69u);
}

// An estimate that drifts by v m/s along x and w rad/s about its own axis has errors of v * delta
// and w * delta over any delta.
TEST(Rpe, ConstantDriftInClosedForm) {
    std::vector<StampedPose> reference, estimate;
    for (int i = 0; i < 200; ++i) {
        const double t = 0.05 * i;
        reference.push_back(PoseAt(t, {0, 0.4 * t, 0}));
        StampedPose drifting = PoseAt(t, {0.03 * t, 0.4 * t, 0});
        estimate.push_back(drifting);
    }
    for (const double delta_s : {0.5, 1.0, 2.0}) {
        const auto result = EvaluateRpe(reference, estimate, {delta_s});
        ASSERT_TRUE(result.ok()) << result.message();
        EXPECT_NEAR(result.value().trans_m.rmse, 0.03 * delta_s, 1e-12);
        EXPECT_NEAR(result.value().rot_rad.max, 0, 1e-12);
    }
    for (std::size_t i = 0; i < estimate.size(); ++i) {
        estimate[i] = reference[i];
        Vector6d twist;
        twist << 0, 0, 0.1 * reference[i].stamp_s, 0, 0, 0;
        estimate[i].T_world_camera.linear() = Se3Exp(twist).linear();
    }
    const auto result = EvaluateRpe(reference, estimate, {2.0});
    ASSERT_TRUE(result.ok());
    EXPECT_NEAR(result.value().rot_rad.rmse, 0.2, 1e-9);
    EXPECT_NEAR(nlohmann::json::parse(RpeJson(result.value())).at("rpe_rot_rmse_deg").get<double>(),
                0.2 * 180 / std::numbers::pi, 1e-6);
}

TEST(Rpe, GapsGiveNoPairs) {
    const auto reference = WindingPath(200);
    auto estimate = reference;
    estimate.erase(estimate.begin() + 60, estimate.begin() + 120);  // a gap of 2 s
    const auto result = EvaluateRpe(reference, estimate);
    ASSERT_TRUE(result.ok());
    for (const RpeResult::Pair& pair : result.value().pairs)
        EXPECT_NEAR(pair.end_s - pair.begin_s, 1.0, 0.1);
    EXPECT_LT(result.value().trans_m.max, 1e-12);
    // In the gap the nearest reference pose is too far away in time to count.
    const auto other = EvaluateRpe(estimate, reference);
    ASSERT_TRUE(other.ok());
    EXPECT_LT(other.value().trans_m.max, 0.2);
    for (const RpeResult::Pair& pair : other.value().pairs) {
        EXPECT_FALSE(pair.begin_s > 102.1 && pair.begin_s < 103.9);
        EXPECT_FALSE(pair.end_s > 102.1 && pair.end_s < 103.9);
    }
}

TEST(Rpe, ErrorsSayWhatIsMissing) {
    const auto path = WindingPath(100);
    EXPECT_NE(EvaluateRpe({}, path).message().find("reference"), std::string::npos);
    EXPECT_NE(EvaluateRpe(path, {path[0]}).message().find("estimated"), std::string::npos);
    EXPECT_NE(EvaluateRpe(path, path, {60}).message().find("60 s apart"), std::string::npos);
    EXPECT_FALSE(EvaluateRpe(path, PosesAt({1, 2, 3, 4})).ok());
    for (const double delta_s : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_FALSE(EvaluateRpe(path, path, {delta_s}).ok());
}

TEST(Rpe, JsonHasTheContractsKeys) {
    const auto path = WindingPath(100);
    RpeResult result = EvaluateRpe(path, path, {0.5}).value();
    result.trans_m = {.median = 2, .max = 3};
    result.rot_rad = {.median = M_PI, .max = M_PI / 2};
    const auto json = nlohmann::json::parse(RpeJson(result));
    EXPECT_EQ(json.size(), 8u);
    EXPECT_TRUE(json.at("rpe_trans_rmse_m").is_number_float());
    EXPECT_EQ(json.at("rpe_trans_median_m"), 2);
    EXPECT_EQ(json.at("rpe_trans_max_m"), 3);
    EXPECT_EQ(json.at("rpe_rot_median_deg"), 180);
    EXPECT_EQ(json.at("rpe_rot_max_deg"), 90);
    EXPECT_EQ(json.at("pairs"), result.pairs.size());
    EXPECT_EQ(json.at("delta_s"), 0.5);
}

}  // namespace
}  // namespace tessera
