#include "io/stamp_pairing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

namespace tessera {
namespace {

// associate.py, written out: all candidates, sorted by gap, each image used once.
std::vector<StampPair> PairSlowly(const std::vector<double>& depth,
                                  const std::vector<double>& colour, double max_gap_s) {
    std::vector<std::tuple<double, double, double, std::size_t, std::size_t>> candidates;
    for (std::size_t d = 0; d < depth.size(); ++d)
        for (std::size_t c = 0; c < colour.size(); ++c)
            if (std::abs(colour[c] - depth[d]) < max_gap_s)
                candidates.emplace_back(std::abs(colour[c] - depth[d]), colour[c], depth[d], d, c);
    std::sort(candidates.begin(), candidates.end());
    std::vector<bool> depth_used(depth.size()), colour_used(colour.size());
    std::vector<StampPair> pairs;
    for (const auto& [gap, cs, ds, d, c] : candidates) {
        if (depth_used[d] || colour_used[c]) continue;
        depth_used[d] = colour_used[c] = true;
        pairs.push_back({d, c});
    }
    std::sort(pairs.begin(), pairs.end(), [](auto& a, auto& b) { return a.depth < b.depth; });
    return pairs;
}

void ExpectSame(const std::vector<StampPair>& a, const std::vector<StampPair>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].depth, b[i].depth) << i;
        EXPECT_EQ(a[i].colour, b[i].colour) << i;
    }
}

TEST(PairNearest, TakesTheClosestFirst) {
    // In time order, depth 0 would take colour 0. But colour 0 and depth 1 are closer.
    const std::vector<double> depth = {10.000, 10.018}, colour = {10.012, 10.030};
    const auto pairs = PairNearest(depth, colour, 0.02);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].depth, 1u);
    EXPECT_EQ(pairs[0].colour, 0u);
}

TEST(PairNearest, TakesWhatIsLeftAcrossATakenPair) {
    const std::vector<double> depth = {0.000, 0.008}, colour = {0.009, 0.015};
    const auto pairs = PairNearest(depth, colour, 0.02);
    ASSERT_EQ(pairs.size(), 2u);
    EXPECT_EQ(pairs[0].colour, 1u);
    EXPECT_EQ(pairs[1].colour, 0u);
}

// Colour 0 was taken with depth 1. The last depth has a partner because its stamps allow it.
TEST(PairNearest, TakesWhatWasTakenAtTheSameTime) {
    const std::vector<double> depth = {0.000, 0.033, 1.000}, colour = {0.013, 0.046, 1.015};
    auto pairs = PairNearest(depth, colour, 0.02, 0.02);
    ASSERT_EQ(pairs.size(), 2u);
    EXPECT_EQ(pairs[0].depth, 1u);
    EXPECT_EQ(pairs[0].colour, 0u);
    EXPECT_EQ(pairs[1].depth, 2u);
    EXPECT_EQ(pairs[1].colour, 2u);
    pairs = PairNearest(depth, colour, 0.02);
    ASSERT_EQ(pairs.size(), 3u);
    EXPECT_EQ(pairs[1].colour, 1u);
}

TEST(PairNearest, TheGapIsStrict) {
    const std::vector<double> depth = {0.0}, colour = {0.25};
    EXPECT_TRUE(PairNearest(depth, colour, 0.25).empty());
    EXPECT_EQ(PairNearest(depth, colour, 0.2500001).size(), 1u);
}

TEST(PairNearest, EqualGapsGoByColourThenDepth) {
    const std::vector<double> depth = {0.5, 1.5, 2.5}, colour = {1.0, 2.0, 3.0};
    ExpectSame(PairNearest(depth, colour, 1.0), PairSlowly(depth, colour, 1.0));
}

TEST(PairNearest, AgreesWithTheSlowWayOnRandomLists) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const auto stamps = [&](double grid) {
            std::vector<double> list;
            for (std::size_t i = 0; i < 5 + random() % 60; ++i)
                list.push_back(1305031229.0 + grid * static_cast<double>(random() % 4000));
            std::sort(list.begin(), list.end());
            list.erase(std::unique(list.begin(), list.end()), list.end());
            return list;
        };
        // A coarse binary grid gives exact ties, a fine one gives none.
        const double grid = seed % 2 == 0 ? 1.0 / 1024 : 0.000317;
        const auto depth = stamps(grid), colour = stamps(grid);
        SCOPED_TRACE(seed);
        ExpectSame(PairNearest(depth, colour, 0.02), PairSlowly(depth, colour, 0.02));
        ExpectSame(PairNearest(depth, colour, 0.5), PairSlowly(depth, colour, 0.5));
    }
}

TEST(PairNearest, ManyStampsInOneInstantStayCheap) {
    std::vector<double> depth, colour;
    for (int i = 0; i < 100000; ++i) {
        depth.push_back(1e-8 * i);
        colour.push_back(1e-8 * i + 3e-9);
    }
    EXPECT_EQ(PairNearest(depth, colour, 0.02).size(), 100000u);
}

// Cameras that are not synchronised: whatever the offset, half an interval is near enough.
TEST(PairGap, IsHalfOfTheSlowerCamerasInterval) {
    const auto every = [](double interval_s) {
        std::vector<double> stamps_s;
        for (int i = 0; i < 9; ++i) stamps_s.push_back(i * interval_s);
        stamps_s.push_back(100);  // a gap does not count
        return stamps_s;
    };
    EXPECT_DOUBLE_EQ(PairGap(0.007, every(0.1), every(0.1)), 0.007);
    EXPECT_DOUBLE_EQ(PairGap(0, every(0.06), every(0.08)), 0.04);
    EXPECT_DOUBLE_EQ(PairGap(0, every(0.08), every(0.06)), 0.04);
    EXPECT_DOUBLE_EQ(PairGap(0, every(1 / 30.0), every(1 / 30.0)), 0.02);
    EXPECT_DOUBLE_EQ(PairGap(0, every(1), every(1)), 0.05);
    EXPECT_DOUBLE_EQ(PairGap(0, {}, std::vector{3.0}), 0.02);
    EXPECT_EQ(
        PairNearest(every(0.08), every(0.08 + 1e-5), PairGap(0, every(0.08), every(0.08))).size(),
        10u);
}

TEST(SmallestGap, IsTheLeastDistanceBetweenTheLists) {
    EXPECT_DOUBLE_EQ(SmallestGap(std::vector{0.0, 10.0}, std::vector{3.0, 8.5}), 1.5);
    EXPECT_EQ(SmallestGap({}, std::vector{3.0}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace tessera
