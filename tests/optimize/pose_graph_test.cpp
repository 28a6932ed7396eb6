#include "optimize/pose_graph.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

Eigen::Isometry3d Pose(double a, double b, double c, double x, double y, double z) {
    return Se3Exp((Vector6d() << a, b, c, x, y, z).finished());
}

// The corners of a square, each turned by a quarter, and a constant error at each step.
class Square : public testing::Test {
  protected:
    void SetUp() override {
        if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
        const Eigen::Isometry3d step =
            Eigen::Translation3d(1, 0, 0) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
        truth.push_back(Pose(0.1, 0.2, 0.3, 4, 5, 6));
        for (int i = 0; i < 4; ++i) truth.push_back(truth.back() * step);
        drifted.push_back(truth[0]);
        for (int i = 0; i < 4; ++i) {
            const Eigen::Isometry3d measured = step * Pose(0, 0, 0.03, 0.05, 0.02, 0);
            edges.push_back({i, i + 1, measured, RootInformation(0.02, 0.02), false});
            drifted.push_back(drifted.back() * measured);
        }
    }
    std::vector<Eigen::Isometry3d> truth, drifted;
    std::vector<PoseEdge> edges;
};

TEST_F(Square, ALoopBringsTheEndToTheStart) {
    edges.push_back({0, 4, truth[0].inverse() * truth[4], RootInformation(0.001, 0.001), true});
    const double before = (drifted[4].translation() - truth[4].translation()).norm();
    auto poses = drifted;
    const Status solved = OptimisePoses(edges, poses);
    ASSERT_TRUE(solved.ok()) << solved.message();
    EXPECT_TRUE(poses[0].isApprox(truth[0], 0));  // the first pose is fixed
    EXPECT_LT((poses[4].translation() - truth[4].translation()).norm(), before / 20);
}

TEST_F(Square, ExactEdgesGiveTheTruthFromAnywhere) {
    edges.clear();
    for (int i = 0; i < 5; ++i)
        for (int j = i + 1; j < 5; ++j)
            edges.push_back(
                {i, j, truth[i].inverse() * truth[j], RootInformation(0.01, 0.01), j > i + 1});
    auto poses = drifted;
    ASSERT_TRUE(OptimisePoses(edges, poses).ok());
    for (int i = 0; i < 5; ++i) EXPECT_LT(Se3Log(poses[i].inverse() * truth[i]).norm(), 1e-6) << i;
}

TEST_F(Square, AWrongLoopAmongRightOnesPullsLittle) {
    for (int i = 0; i < 4; ++i) edges[i].T_from_to = truth[i].inverse() * truth[i + 1];
    edges.push_back({0, 4, truth[0].inverse() * truth[4], RootInformation(0.01, 0.01), true});
    edges.push_back({1, 4, truth[1].inverse() * truth[4] * Pose(0, 0, 0, 0, 3, 0),
                     RootInformation(0.01, 0.01), true});
    auto poses = truth;
    ASSERT_TRUE(OptimisePoses(edges, poses).ok());
    EXPECT_LT((poses[4].translation() - truth[4].translation()).norm(), 0.01);
}

// When the camera returns after drift, tracking jumps from the new surface to the old one. Loops on
// both sides of the jump show that the camera did not move.
TEST_F(Square, AJumpOfTrackingAmongLoopsIsNoMotion) {
    constexpr int kPoses = 20, kJump = 10;
    edges.clear();
    truth.assign(1, truth[0]);
    for (int i = 1; i < kPoses; ++i) truth.push_back(truth.back() * Pose(0, 0, 0.02, 0.1, 0, 0));
    for (int i = 0; i + 1 < kPoses; ++i) {
        const Eigen::Isometry3d jump =
            i == kJump ? Pose(0, 0, 0, 0, 0.06, 0) : Eigen::Isometry3d::Identity();
        edges.push_back({i, i + 1, truth[i].inverse() * truth[i + 1] * jump,
                         RootInformation(0.003, 0.003), false});
    }
    for (int i = kJump - 3; i <= kJump + 4; ++i)
        edges.push_back({0, i, truth[0].inverse() * truth[i], RootInformation(0.005, 0.01), true});
    auto poses = truth;
    ASSERT_TRUE(OptimisePoses(edges, poses).ok());
    for (int i = 0; i < kPoses; ++i)
        EXPECT_LT((poses[i].translation() - truth[i].translation()).norm(), 0.015) << i;
}

TEST_F(Square, NothingToDoWithoutEdges) {
    auto poses = drifted;
    ASSERT_TRUE(OptimisePoses({}, poses).ok());
    EXPECT_TRUE(poses[3].isApprox(drifted[3], 0));
}

}  // namespace
}  // namespace tessera
