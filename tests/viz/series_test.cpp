#include "viz/series.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(Series, KeepsTheNewestInOrder) {
    Series series(3);
    EXPECT_EQ(series.size(), 0u);
    EXPECT_EQ(series.last(), 0);
    for (int i = 1; i <= 5; ++i) series.Add(static_cast<float>(i));
    ASSERT_EQ(series.size(), 3u);
    EXPECT_EQ(series[0], 3);
    EXPECT_EQ(series[1], 4);
    EXPECT_EQ(series.last(), 5);
    EXPECT_EQ(series.max(), 5);
    series.Add(-1);
    series.Add(-2);
    series.Add(-3);
    EXPECT_EQ(series.max(), 0);
    series.Clear();
    EXPECT_EQ(series.size(), 0u);
}

TEST(Series, AxesEndAtRoundNumbers) {
    for (const auto& [value, end] : {std::pair{0.0f, 1.0f},
                                     {1.0f, 1.0f},
                                     {1.1f, 2.0f},
                                     {2.1f, 5.0f},
                                     {7.0f, 10.0f},
                                     {0.03f, 0.05f},
                                     {101.0f, 200.0f},
                                     {1000.0f, 1000.0f}})
        EXPECT_NEAR(AxisEnd(value), end, 1e-5f * end) << value;
}

}  // namespace
}  // namespace tessera
