#include "finish/atlas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tessera {
namespace {

std::vector<Chart> RandomCharts(int count, float largest_m) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> side(0.0f, largest_m);
    std::vector<Chart> charts(static_cast<std::size_t>(count));
    for (Chart& chart : charts) chart.size_m = {side(random), side(random)};
    return charts;
}

void ExpectApart(const std::vector<Chart>& charts, const Atlas& atlas) {
    Image<int> owner(atlas.width, atlas.height, -1);
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const auto texels = [&](float m) { return static_cast<int>(std::ceil(m / atlas.texel_m)); };
        const Eigen::Vector2i low = atlas.corner[i] - Eigen::Vector2i::Constant(Atlas::kMargin);
        const Eigen::Vector2i high =
            atlas.corner[i] +
            Eigen::Vector2i(texels(charts[i].size_m.x()), texels(charts[i].size_m.y())) +
            Eigen::Vector2i::Constant(Atlas::kMargin);
        for (int y = low.y(); y <= high.y(); ++y)
            for (int x = low.x(); x <= high.x(); ++x) {
                ASSERT_TRUE(owner.Contains(x, y)) << i;
                ASSERT_EQ(owner(x, y), -1) << i;
                owner(x, y) = static_cast<int>(i);
            }
    }
}

TEST(Atlas, ChartsLieApartWithTheirMargins) {
    const std::vector<Chart> charts = RandomCharts(300, 0.2f);
    const Result<Atlas> atlas = PackCharts(charts, 0.002, 4096);
    ASSERT_TRUE(atlas.ok()) << atlas.message();
    EXPECT_EQ(atlas.value().texel_m, 0.002);
    ExpectApart(charts, atlas.value());
    double area = 0;
    for (const Chart& chart : charts)
        area += static_cast<double>(chart.size_m.prod()) / (0.002 * 0.002);
    EXPECT_GT(area / (static_cast<double>(atlas.value().width) * atlas.value().height), 0.4);
}

TEST(Atlas, TexelsGrowUntilTheyFit) {
    const std::vector<Chart> charts = RandomCharts(300, 0.4f);
    const Result<Atlas> atlas = PackCharts(charts, 0.001, 512);
    ASSERT_TRUE(atlas.ok()) << atlas.message();
    EXPECT_GT(atlas.value().texel_m, 0.001);
    EXPECT_LE(atlas.value().width, 512);
    EXPECT_LE(atlas.value().height, 512);
    ExpectApart(charts, atlas.value());
}

TEST(Atlas, TooManyPiecesAreAnError) {
    const Result<Atlas> atlas = PackCharts(RandomCharts(3000, 0.01f), 0.001, 256);
    ASSERT_FALSE(atlas.ok());
    EXPECT_NE(atlas.message().find("3000 charts"), std::string::npos) << atlas.message();
    for (const char* option : {"--texture", "--island", "--box"})
        EXPECT_NE(atlas.message().find(option), std::string::npos) << atlas.message();
    // A box has at least 6 x 6 texels: 42 x 42 of them fit.
    EXPECT_TRUE(PackCharts(RandomCharts(42 * 42, 0.01f), 0.001, 256).ok());
}

TEST(Atlas, AChartsOriginIsAtItsCorner) {
    std::vector<Chart> charts = RandomCharts(3, 0.1f);
    for (Chart& chart : charts) chart.origin = {1, 2, 3};
    const Result<Atlas> atlas = PackCharts(charts, 0.002, 1024);
    ASSERT_TRUE(atlas.ok());
    EXPECT_EQ(atlas.value().TexelOf(charts[1], 1, {1, 2, 3}),
              atlas.value().corner[1].cast<float>());
    const Eigen::Vector2f beside = atlas.value().TexelOf(charts[1], 1, {1.02f, 2.01f, 3});
    EXPECT_NEAR((beside - atlas.value().corner[1].cast<float>() - Eigen::Vector2f(10, 5)).norm(), 0,
                1e-3f);
}

TEST(Atlas, AShrunkChartTakesFewerTexelsForTheSamePlaces) {
    Chart chart;
    chart.origin = {1, 2, 3};
    chart.size_m = {0.4f, 0.2f};
    chart.Shrink(0.25f);
    EXPECT_NEAR((chart.Place({1.4f, 2.2f, 3}) - chart.size_m).norm(), 0, 1e-6f);
    EXPECT_NEAR((chart.size_m - Eigen::Vector2f(0.1f, 0.05f)).norm(), 0, 1e-6f);
}

}  // namespace
}  // namespace tessera
