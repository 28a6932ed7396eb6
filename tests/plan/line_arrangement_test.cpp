#include "plan/line_arrangement.h"

#include <gtest/gtest.h>

#include <random>

namespace tessera {
namespace {

// Cells are counter-clockwise, edges lie on their lines, and neighbours know each other.
void ExpectConsistent(const LineArrangement& cut) {
    for (std::size_t i = 0; i < cut.cells().size(); ++i) {
        const ArrangementCell& cell = cut.cells()[i];
        EXPECT_GT(SignedArea(cell.corners), 0);
        for (std::size_t e = 0; e < cell.edges.size(); ++e) {
            if (cell.edges[e].line == ArrangementCell::kNone) continue;
            const PlanLine& line = cut.lines()[static_cast<std::size_t>(cell.edges[e].line)];
            EXPECT_NEAR(line.Distance(cell.corners[e]), 0, 1e-5);
            ASSERT_NE(cell.edges[e].neighbour, ArrangementCell::kNone);
            const auto other = static_cast<std::size_t>(cell.edges[e].neighbour);
            EXPECT_TRUE(std::ranges::any_of(cut.cells()[other].edges, [&](const auto& edge) {
                return edge.neighbour == static_cast<int>(i);
            }));
        }
    }
}

TEST(LineArrangement, CutsTheFrameWithoutRest) {
    int complete = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> angle(0, 3.14), offset(-2, 2);
        std::vector<PlanLine> lines;
        for (int i = 0; i < 12; ++i) {
            const double a = angle(random);
            lines.push_back({{std::cos(a), std::sin(a)}, offset(random)});
        }
        const LineArrangement cut(lines,
                                  {Eigen::Vector2d(-9000, -9000), Eigen::Vector2d(9000, 9000)});
        double sum = 0;
        for (const ArrangementCell& cell : cut.cells()) sum += cell.area_m2;
        EXPECT_NEAR(sum, 18000.0 * 18000.0, 1e-2);
        // Every two lines cross inside: 1 + n + n (n - 1) / 2 cells, but for specks.
        EXPECT_LE(cut.cells().size(), 79U);
        EXPECT_GE(cut.cells().size(), 75U);
        if (cut.cells().size() < 79) continue;
        ++complete;
        ExpectConsistent(cut);
    }
    EXPECT_GE(complete, 10);
}

TEST(LineArrangement, FindsTheCellAroundAPoint) {
    const LineArrangement cut({{{1, 0}, 1}, {{0, 1}, 1}},
                              {Eigen::Vector2d(0, 0), Eigen::Vector2d(3, 4)});
    ASSERT_EQ(cut.cells().size(), 4U);
    const auto area = [&](double x, double y) {
        const int cell = cut.Find({x, y});
        return cell == ArrangementCell::kNone ? 0
                                              : cut.cells()[static_cast<std::size_t>(cell)].area_m2;
    };
    EXPECT_NEAR(area(0.5, 0.5), 1, 1e-9);
    EXPECT_NEAR(area(2, 2), 6, 1e-9);
    EXPECT_NEAR(area(0.5, 2), 3, 1e-9);
    EXPECT_EQ(area(-1, 2), 0);
}

}  // namespace
}  // namespace tessera
