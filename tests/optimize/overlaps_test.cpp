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
    EXPECT_FALSE(AlignedFactor(Chain(std::vector<double>(39, 0.001))).has_value());
    EXPECT_TRUE(AlignedFactor(Chain(std::vector<double>(40, 0.001))).has_value());
}

// Information 0.5e6 / m^2: a standard deviation of 1.414 mm.
TEST(Overlaps, TheFactorIsTheUpperQuartileOfTheSquaredDifferences) {
    EXPECT_DOUBLE_EQ(*AlignedFactor(Chain(std::vector<double>(41, 0.0005))), 1.0);
    std::vector<double> off(41, 0.0141421);
    off[3] = 0.5;  // one outlier
    EXPECT_NEAR(*AlignedFactor(Chain(off)), 100 / 7.84, 0.1);
}

// Each of 41 keyframes was tracked 10 mm from its alignment with the one before, and `older_off_m`
// from that with the eighth before.
CovarianceFactors FactorsOf(double older_off_m) {
    Keyframes keyframes = Chain(std::vector<double>(41, 0.01));
    std::vector<PoseEdge> edges;
    for (int id = 1; id < keyframes.size(); ++id) {
        edges.push_back({id - 1, id, Eigen::Isometry3d::Identity(), RootInformation(0.002, 0.002)});
        if (id < 8) continue;
        Overlap older = Measured(older_off_m, 0.5e6);
        older.with = id - 8;
        keyframes[id].overlaps.push_back(older);
    }
    edges.push_back({0, 41, Eigen::Isometry3d::Identity(), RootInformation(1, 1), true});
    return *FindCovarianceFactors(keyframes, edges);
}

TEST(Overlaps, ErrorsThatDoNotAddUpAreTheAlignments) {
    const CovarianceFactors factors = FactorsOf(0.01);
    EXPECT_NEAR(factors.aligned, 50 / 7.84, 0.01);
    EXPECT_EQ(factors.tracked, 1);
}

// 80 mm in eight keyframes; the alignments take 2 mm^2 times 6.38 of it, each keyframe 4 mm^2.
TEST(Overlaps, ErrorsThatAddUpAreTrackings) {
    const CovarianceFactors factors = FactorsOf(0.08);
    EXPECT_NEAR(factors.tracked, (6400 / 7.84 - 2 * 6.38) / (8 * 4), 0.2);
    EXPECT_EQ(factors.aligned, 1);
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
    const std::vector<PoseEdge> near = OverlapEdges(Chain({0.003}), {});
    ASSERT_EQ(near.size(), 1u);
    // Tracking 2 mm, alignment 1.414 mm: a third of the difference.
    EXPECT_NEAR(near[0].T_from_to.translation().x(), 0.001, 1e-5);
    EXPECT_NEAR(near[0].root_information(3, 3), std::sqrt(0.5e6), 5);
    const std::vector<PoseEdge> far = OverlapEdges(Chain({0.1}), {});
    EXPECT_NEAR(far[0].T_from_to.translation().x(), 0, 1e-9);
    EXPECT_NEAR(far[0].root_information(3, 3), std::sqrt(0.5e6), 5);
    // With a large factor tracking counts.
    EXPECT_NEAR(OverlapEdges(Chain({0.003}), {100, 1})[0].T_from_to.translation().x(), 0.003, 1e-4);
}

}  // namespace
}  // namespace tessera
