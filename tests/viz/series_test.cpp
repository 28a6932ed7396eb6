#include "viz/series.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(Series, KeepsTheNewestInOrder) {
    Series series;
    const int count = static_cast<int>(kSeriesLength) + 2;
    for (int i = 1; i <= count; ++i) AddValue(static_cast<float>(i), series);
    ASSERT_EQ(series.size(), kSeriesLength);
    EXPECT_EQ(series[0], 3);
    EXPECT_EQ(series[1], 4);
    EXPECT_EQ(series.back(), static_cast<float>(count));
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
