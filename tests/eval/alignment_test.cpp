#include "eval/alignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "eval/test_trajectories.h"
#include "render/random_mesh.h"

namespace tessera {
namespace {

using Pairs = std::vector<PosePair>;

// Works like associate.py: all pairs within the limit, sorted by difference. A pair is taken if
// neither pose has been used.
Pairs AssociateByHand(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b,
                      double max_difference_s) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> all;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j)
            if (const double d = std::abs(a[i].stamp_s - b[j].stamp_s); d < max_difference_s)
                all.emplace_back(d, i, j);
    std::sort(all.begin(), all.end());
    std::vector<bool> a_taken(a.size()), b_taken(b.size());
    Pairs pairs;
    for (const auto& [d, i, j] : all)
        if (!a_taken[i] && !b_taken[j]) {
            a_taken[i] = b_taken[j] = true;
            pairs.push_back({i, j});
        }
    std::sort(pairs.begin(), pairs.end(),
              [](const PosePair& x, const PosePair& y) { return x.reference < y.reference; });
    return pairs;
}

TEST(Association, TheClosestFirst) {
    // 1.008 is nearer to 1.010 than 1.000 is, so 1.000 stays unpaired.
    EXPECT_EQ(AssociateByTime(PosesAt({1.010}), PosesAt({1.000, 1.008})), (Pairs{{0, 1}}));
    // 1.010-1.011 is taken first. The remaining two are paired across it.
    EXPECT_EQ(AssociateByTime(PosesAt({1.000, 1.010}), PosesAt({1.011, 1.015})),
              (Pairs{{0, 1}, {1, 0}}));
    EXPECT_EQ(AssociateByTime(PosesAt({1.000, 1.010}), PosesAt({1.011, 1.021})), (Pairs{{1, 0}}));
}

TEST(Association, LimitAndTies) {
    EXPECT_TRUE(AssociateByTime(PosesAt({1.0}), PosesAt({1.5}), 0.5).empty());
    EXPECT_EQ(AssociateByTime(PosesAt({1.0}), PosesAt({1.5}), 0.6).size(), 1u);
    EXPECT_EQ(AssociateByTime(PosesAt({1.0, 2.0}), PosesAt({1.5}), 0.6), (Pairs{{0, 0}}));
    EXPECT_EQ(AssociateByTime(PosesAt({1.5}), PosesAt({1.0, 2.0}), 0.6), (Pairs{{0, 0}}));
    EXPECT_TRUE(AssociateByTime({}, PosesAt({1.0})).empty());
    EXPECT_TRUE(AssociateByTime(PosesAt({1.0}), {}).empty());
}

TEST(Association, AgreesWithTryingAllPairs) {
    TestRandom random(11);
    for (int n = 0; n < 300; ++n) {
        const auto stamps = [&] {
            std::vector<double> s;
            for (int i = 0; i < 40; ++i) s.push_back(std::floor(random.Next() * 512) / 512);
            std::sort(s.begin(), s.end());
            s.erase(std::unique(s.begin(), s.end()), s.end());
            return PosesAt(s);
        };
        const auto a = stamps(), b = stamps();
        EXPECT_EQ(AssociateByTime(a, b, 0.03), AssociateByHand(a, b, 0.03)) << n;
    }
}

TEST(Association, ManyPosesAtNearlyTheSameTime) {
    std::vector<double> a, b;
    for (int i = 0; i < 100000; ++i) {
        a.push_back(i * 1e-8);
        b.push_back(i * 1e-8 + 4e-9);
    }
    EXPECT_EQ(AssociateByTime(PosesAt(a), PosesAt(b)).size(), 100000u);
}

TEST(Alignment, FindsTheRigidMotion) {
    const auto reference = WindingPath(200);
    const auto alignment =
        AlignTrajectories(reference, Moved(reference, SomeTransform().inverse()));
    ASSERT_TRUE(alignment.ok()) << alignment.message();
    EXPECT_LT((alignment.value().T_reference_estimate.matrix() - SomeTransform().matrix()).norm(),
              1e-12);
    EXPECT_TRUE(alignment.value().warning.empty());
}

TEST(Alignment, NeverMirrors) {
    auto reference = WindingPath(50), estimate = reference;
    for (StampedPose& pose : estimate) pose.T_world_camera.translation().x() *= -1;
    const auto alignment = AlignTrajectories(reference, estimate);
    ASSERT_TRUE(alignment.ok());
    EXPECT_NEAR(alignment.value().T_reference_estimate.linear().determinant(), 1, 1e-12);
}

TEST(Alignment, WarnsWhereTheRotationIsOpen) {
    std::vector<StampedPose> line, point;
    for (int i = 0; i < 10; ++i) {
        line.push_back(PoseAt(i, {0.1 * i, 0.2 * i, 0}));
        point.push_back(PoseAt(i, {1, 2, 3}));
    }
    const auto along_line = AlignTrajectories(line, line);
    ASSERT_TRUE(along_line.ok());
    EXPECT_NE(along_line.value().warning.find("along a line"), std::string::npos);
    const auto at_point = AlignTrajectories(point, point);
    ASSERT_TRUE(at_point.ok());
    EXPECT_NE(at_point.value().warning.find("hardly moved"), std::string::npos);
    EXPECT_TRUE(at_point.value().T_reference_estimate.matrix().allFinite());
}

TEST(Alignment, ErrorsSayWhatIsMissing) {
    const auto path = WindingPath(10);
    const auto message = [](const std::vector<StampedPose>& a, const std::vector<StampedPose>& b) {
        return AlignTrajectories(a, b).message();
    };
    EXPECT_NE(message({}, path).find("reference trajectory is empty"), std::string::npos);
    EXPECT_NE(message(path, {}).find("estimated trajectory is empty"), std::string::npos);
    EXPECT_NE(message(path, PosesAt({1, 2, 3})).find("same sequence?"), std::string::npos);
    EXPECT_NE(message(path, {path[0], path[1]}).find("only 2 of"), std::string::npos);
    EXPECT_TRUE(AlignTrajectories(path, {path[0], path[1], path[2]}).ok());
}

}  // namespace
}  // namespace tessera
