#include "optimize/overlaps.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

Overlap Measured(double tracked_off_m, double information) {
    Overlap overlap;
    overlap.information = information * Matrix6d::Identity();
    overlap.T_with_this_tracked = Eigen::Isometry3d(Eigen::Translation3d(tracked_off_m, 0, 0));
    return overlap;
}

// A chain of keyframes; keyframe i overlaps with i - 1, tracked `off_m` from its alignment.
Keyframes Chain(const std::vector<double>& off_m) {
    std::vector<Keyframe> list(off_m.size() + 1);
    for (std::size_t i = 0; i < list.size(); ++i) {
        list[i].id = static_cast<int>(i);
        if (i == 0) continue;
        list[i].overlaps.push_back(Measured(off_m[i - 1], 0.5e6));
        list[i].overlaps.back().with = static_cast<int>(i) - 1;
    }
    Keyframes keyframes(PinholeCamera{}, 0.8, 100);
    keyframes.Resume(std::move(list));
    return keyframes;
}

TEST(Overlaps, TooFewSayNothingAboutTheirErrors) {
    EXPECT_FALSE(CovarianceFactor(Chain(std::vector<double>(39, 0.001))).has_value());
    EXPECT_TRUE(CovarianceFactor(Chain(std::vector<double>(40, 0.001))).has_value());
}

// Information 0.5e6 / m^2: a standard deviation of 1.414 mm.
TEST(Overlaps, TheFactorIsTheUpperQuartileOfTheSquaredDifferences) {
    EXPECT_DOUBLE_EQ(*CovarianceFactor(Chain(std::vector<double>(41, 0.0005))), 1.0);
    std::vector<double> off(41, 0.0141421);
    off[3] = 0.5;  // one outlier
    EXPECT_NEAR(*CovarianceFactor(Chain(off)), 100 / 7.84, 0.1);
}

TEST(Overlaps, ContradictionGrowsWithTheFactor) {
    EXPECT_FALSE(Contradicts(Measured(0.005, 0.5e6), 1));
    EXPECT_TRUE(Contradicts(Measured(0.008, 0.5e6), 1));  // 5.7 standard deviations
    EXPECT_FALSE(Contradicts(Measured(0.008, 0.5e6), 10));
    Overlap untracked = Measured(1, 1e6);
    untracked.T_with_this_tracked.reset();
    EXPECT_FALSE(Contradicts(untracked, 1));
}

TEST(Overlaps, AnEdgeIsTheMeanUnlessTrackingIsExcluded) {
    const std::vector<PoseEdge> near = OverlapEdges(Chain({0.003}), 1);
    ASSERT_EQ(near.size(), 1u);
    // Tracking 2 mm, alignment 1.414 mm: a third of the difference.
    EXPECT_NEAR(near[0].T_from_to.translation().x(), 0.001, 1e-5);
    EXPECT_NEAR(near[0].root_information(3, 3), std::sqrt(0.5e6), 5);
    const std::vector<PoseEdge> far = OverlapEdges(Chain({0.1}), 1);
    EXPECT_NEAR(far[0].T_from_to.translation().x(), 0, 1e-9);
    EXPECT_NEAR(far[0].root_information(3, 3), std::sqrt(0.5e6), 5);
    // With a large factor tracking counts.
    EXPECT_NEAR(OverlapEdges(Chain({0.003}), 100)[0].T_from_to.translation().x(), 0.003, 1e-4);
}

}  // namespace
}  // namespace tessera
