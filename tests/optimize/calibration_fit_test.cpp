// Tests of a fit's uncertainty in a case with a closed-form answer: one unknown, the mean of the
// data.
#include "optimize/calibration_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace tessera {
namespace {

// residual = unknown - y at the solution, with one pair per residual.
CalibrationFit MeanOf(const std::vector<double>& y) {
    CalibrationFit fit;
    const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
    const auto rows = static_cast<Eigen::Index>(y.size());
    fit.jacobian.resize(rows, 1);
    fit.residuals.resize(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
        fit.jacobian.insert(i, 0) = 1;
        fit.residuals(i) = mean - y[static_cast<std::size_t>(i)];
    }
    fit.pairs.resize(y.size());
    fit.unknowns = 1;
    return fit;
}

TEST(JackknifeSpread, IsTheOneOfTheMeansWithoutEachPart) {
    const std::vector<double> y{1, 4, 2, 8, 5, 7, 1, 1};
    const std::vector<int> part{0, 0, 1, 1, 1, 2, 3, 3};
    std::vector<double> without;
    for (int p = 0; p < 4; ++p) {
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < y.size(); ++i)
            if (part[i] != p) sum += y[i], ++count;
        without.push_back(sum / count);
    }
    const double mean = std::accumulate(without.begin(), without.end(), 0.0) / 4;
    double squares = 0;
    for (double value : without) squares += (value - mean) * (value - mean);
    EXPECT_NEAR(JackknifeSpread(MeanOf(y), part, 4)(0), std::sqrt(0.75 * squares), 1e-12);
}

TEST(JackknifeSpread, OfOneValueAPartIsTheMeansStandardError) {
    const std::vector<double> y{3, -1, 4, 1, -5};
    double squares = 0;
    for (double value : y) squares += (value - 0.4) * (value - 0.4);
    EXPECT_NEAR(JackknifeSpread(MeanOf(y), {0, 1, 2, 3, 4}, 5)(0), std::sqrt(squares / 4 / 5),
                1e-12);
}

// Rows before the pairs hold prior knowledge. They are never left out.
TEST(JackknifeSpread, WhatIsKnownBeforeStaysIn) {
    CalibrationFit fit = MeanOf({0, 0, 1, 5});
    fit.pairs.resize(2);  // for the last two rows
    EXPECT_NEAR(JackknifeSpread(fit, {0, 1}, 2)(0),
                std::sqrt(0.5) * (5.0 / 3 - 1.0 / 3) / std::sqrt(2.0), 1e-12);
}

// The scatter of the residuals is the same in every test. Only the location of the pairs that
// disagree differs.
class WhereItLies : public testing::Test {
  protected:
    static constexpr std::size_t kPairs = 960;

    template <class Place>
    double Deviation(const Place& place) const {
        std::vector<double> y;
        for (std::size_t i = 0; i < kPairs; ++i) y.push_back(i < kPairs / 2 ? 1.0 : -1.0);
        CalibrationFit fit = MeanOf(y);
        fit.views = 960;
        for (std::size_t i = 0; i < kPairs; ++i) {
            const std::size_t mixed = i * 7919 % kPairs, other = i * 7907 % kPairs;
            PlanePair& p = fit.pairs[i];
            p.from = p.to = static_cast<int>(i * 6151 % kPairs);
            p.depth_to_m = 1 + static_cast<double>(mixed) / kPairs;
            const double angle = 0.1 + 6.2831853 * static_cast<double>(i * 7883 % kPairs) / kPairs;
            p.direction_to = std::sqrt(static_cast<double>(other) / kPairs) *
                             Eigen::Vector2d(std::cos(angle), std::sin(angle));
            place(i, p);
        }
        return Deviations(fit)(0);
    }
    const double scatter = 1 / std::sqrt(double{kPairs});  // of the mean, from the residuals alone
};

TEST_F(WhereItLies, ScatterThatIsTheSameEverywhereCountsAsScatter) {
    const double mixed = Deviation([](std::size_t, PlanePair&) {});
    EXPECT_GT(mixed, scatter);
    EXPECT_LT(mixed, 4 * scatter);
}

TEST_F(WhereItLies, PartsThatDisagreeMakeItLarge) {
    const double large = 8 * scatter;
    EXPECT_GT(Deviation([](std::size_t i, PlanePair& p) { p.from = p.to = static_cast<int>(i); }),
              large);
    EXPECT_GT(Deviation([](std::size_t i, PlanePair& p) { p.depth_to_m = static_cast<double>(i); }),
              large);
    EXPECT_GT(Deviation([](std::size_t i, PlanePair& p) {
                  p.direction_to = p.direction_to.normalized() * static_cast<double>(i + 1);
              }),
              large);
    EXPECT_GT(Deviation([](std::size_t i, PlanePair& p) {
                  p.direction_to.x() = i < kPairs / 2 ? 0.5 : -0.5;
              }),
              large);
}

}  // namespace
}  // namespace tessera
