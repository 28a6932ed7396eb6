#include "core/quantile.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(Quantile, IsTheValueOfItsRank) {
    std::vector<int> values{7, 1, 9, 3, 5, 2, 8, 0, 6, 4};
    EXPECT_EQ(Quantile(values, 0), 0);
    EXPECT_EQ(Quantile(values, 0.25), 2);
    EXPECT_EQ(Quantile(values, 0.75), 7);
    EXPECT_EQ(Quantile(values, 1), 9);
    EXPECT_EQ(Quantile(std::vector<float>{2.5f}, 0.9), 2.5f);
}

TEST(Quantile, TheMedianOfAnEvenNumberIsTheUpperOne) {
    EXPECT_EQ(Median(std::vector<int>{4, 1, 3, 2}), 3);
    EXPECT_EQ(Median(std::vector<int>{3, 1, 2}), 2);
}

TEST(Quantile, OfADepthImageTheMeasuredPixelsCount) {
    DepthImage depth_m(3, 2, 0.0f);
    EXPECT_EQ(MedianDepth(depth_m), 0);
    depth_m(0, 0) = 1;
    depth_m(1, 0) = 4;
    depth_m(2, 1) = 2;
    EXPECT_EQ(MedianDepth(depth_m), 2);
}

}  // namespace
}  // namespace tessera
