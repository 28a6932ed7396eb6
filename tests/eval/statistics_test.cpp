#include "eval/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera {
namespace {

TEST(Statistics, KnownAnswers) {
    const ErrorStatistics s = Summarise({4, 1, 3, 2, 10});
    EXPECT_DOUBLE_EQ(s.mean, 4);
    EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(26.0));
    EXPECT_DOUBLE_EQ(s.std, std::sqrt(10.0));
    EXPECT_DOUBLE_EQ(s.median, 3);
    EXPECT_DOUBLE_EQ(s.max, 10);
}

TEST(Statistics, MedianOfAnEvenCount) {
    EXPECT_DOUBLE_EQ(Summarise({8, 1, 4, 2}).median, 3);
    EXPECT_DOUBLE_EQ(Summarise({5, 1}).median, 3);
}

TEST(Statistics, OneAndNone) {
    const ErrorStatistics one = Summarise({7});
    EXPECT_EQ(one.median, 7);
    EXPECT_EQ(one.max, 7);
    EXPECT_EQ(one.std, 0);
    EXPECT_EQ(Summarise({}).rmse, 0);
}

}  // namespace
}  // namespace tessera
