#include "plan/min_cut.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace tessera {
namespace {

// Against all 2^8 divisions.
TEST(MinCut, FindsTheCheapestDivision) {
    constexpr std::size_t kNodes = 8;
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> cost(0, 1);
        std::array<double, kNodes> first{}, second{};
        std::array<std::array<double, kNodes>, kNodes> pair{};
        MinCut cut(kNodes);
        for (std::size_t i = 0; i < kNodes; ++i) {
            first[i] = cost(random);
            second[i] = cost(random);
            cut.AddNode(i, first[i], second[i]);
            for (std::size_t k = 0; k < i; ++k)
                if (cost(random) < 0.5) cut.AddPair(i, k, pair[i][k] = cost(random));
        }
        // Bit i of `mask`: node i is on the first side.
        const auto price = [&](unsigned mask) {
            double sum = 0;
            for (std::size_t i = 0; i < kNodes; ++i) {
                const bool on_first = (mask >> i & 1U) != 0;
                sum += on_first ? second[i] : first[i];
                for (std::size_t k = 0; k < i; ++k)
                    if (on_first != ((mask >> k & 1U) != 0)) sum += pair[i][k];
            }
            return sum;
        };
        double least = 1e9;
        for (unsigned mask = 0; mask < (1U << kNodes); ++mask) least = std::min(least, price(mask));
        const std::vector<bool> sides = cut.Solve();
        unsigned found = 0;
        for (std::size_t i = 0; i < kNodes; ++i) found |= sides[i] ? 1U << i : 0U;
        EXPECT_NEAR(price(found), least, 1e-9) << seed;
    }
}

}  // namespace
}  // namespace tessera
