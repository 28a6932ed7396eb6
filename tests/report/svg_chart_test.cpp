#include "report/svg_chart.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera {
namespace {

TEST(RoundTicks, AreRoundAndWithin) {
    EXPECT_EQ(RoundTicks(0, 1, 5), (std::vector<double>{0, 0.5, 1}));
    EXPECT_EQ(RoundTicks(0, 105, 6), (std::vector<double>{0, 50, 100}));
    EXPECT_EQ(RoundTicks(-3, 3.5, 8), (std::vector<double>{-3, -2, -1, 0, 1, 2, 3}));
    EXPECT_TRUE(RoundTicks(1, 1, 5).empty());
    for (double high = 1e-4; high < 1e6; high *= 1.37) {
        const std::vector<double> ticks = RoundTicks(0, high, 6);
        EXPECT_LE(ticks.size(), 6u) << high;
        EXPECT_GE(ticks.size(), 2u) << high;
        EXPECT_LE(ticks.back(), high * (1 + 1e-9));
    }
}

TEST(ThinnedCurve, KeepsExtremes) {
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 10000; ++i) points.emplace_back(i, i == 7777 ? 50 : i % 3);
    const auto thinned = ThinnedCurve(points, 0, 9999, 100);
    EXPECT_LE(thinned.size(), 200u);
    EXPECT_TRUE(std::ranges::is_sorted(thinned, {}, [](const auto& p) { return p.x(); }));
    EXPECT_EQ(std::ranges::max(thinned, {}, [](const auto& p) { return p.y(); }).x(), 7777);
}

TEST(ChartSvg, DrawsAxesWithUnitsAndCurves) {
    ChartSpec spec{"<error>", "seconds", "error, mm", 0, 10, {{"e", "c1", {{0, 0}, {10, 5}}}}, 5};
    const std::string svg = ChartSvg(spec);
    EXPECT_NE(svg.find("aria-label=\"&lt;error&gt;\""), std::string::npos);
    EXPECT_NE(svg.find(">seconds<"), std::string::npos);
    EXPECT_NE(svg.find(">error, mm<"), std::string::npos);
    // From the lower left to the upper right corner of the plot.
    EXPECT_NE(svg.find("points=\"56.0,196.0 546.0,26.0 \""), std::string::npos) << svg;
}

TEST(ChartSvg, PiecesOfAStrip) {
    ChartSpec axis;
    axis.x_high = 10;
    const std::string svg = StripSvg(axis, {{0, 5, "fused"}, {5, 5, "lost"}});
    EXPECT_NE(svg.find("class=\"fused\" x=\"56.00\" y=\"26\" width=\"245.00\""), std::string::npos)
        << svg;
    // However short, it can be seen.
    EXPECT_NE(svg.find("class=\"lost\" x=\"301.00\" y=\"26\" width=\"1.00\""), std::string::npos);
}

}  // namespace
}  // namespace tessera
