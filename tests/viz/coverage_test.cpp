#include "viz/coverage.h"

#include <gtest/gtest.h>

#include "render/vertex_weight.h"

namespace tessera {
namespace {

GeometryBlock BlockOf(BlockId id, std::initializer_list<float> weights) {
    GeometryBlock block;
    block.id = id;
    for (const float weight : weights) {
        block.geometry.vertices.emplace_back();
        block.geometry.vertices.back().mark.weight = WeightStep(weight);
    }
    return block;
}

TEST(Coverage, TheLevelsFollowFromTheWeights) {
    const CoverageLevels usual = CoverageLevels::Of(128);
    EXPECT_EQ(usual.once, WeightStep(2));
    EXPECT_EQ(usual.well, WeightStep(10));
    const CoverageLevels small = CoverageLevels::Of(8);  // a map that soon forgets
    EXPECT_EQ(small.well, WeightStep(4));
    EXPECT_LT(small.once, small.well);
}

TEST(Coverage, CountsEachBlockOnceHoweverOftenItIsMeshed) {
    Coverage coverage(CoverageLevels::Of(128));
    EXPECT_EQ(coverage.well_share(), 0);
    EXPECT_EQ(coverage.thin_share(), 0);
    coverage.Take(std::vector{BlockOf(1, {1, 1, 4, 20}), BlockOf(7, {30, 30, 30, 1})});
    EXPECT_DOUBLE_EQ(coverage.well_share(), 0.5);
    EXPECT_DOUBLE_EQ(coverage.thin_share(), 0.5);
    coverage.Take(std::vector{BlockOf(1, {12, 12, 12, 20})});
    EXPECT_DOUBLE_EQ(coverage.well_share(), 7.0 / 8);
    coverage.Take(std::vector{BlockOf(7, {})});  // its surface is gone
    EXPECT_DOUBLE_EQ(coverage.well_share(), 1);
}

}  // namespace
}  // namespace tessera
