#include "cuda/device_loops.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera::serial {
namespace {

struct AddPowers {
    const float* values;
    TESSERA_HD_MEMBER void operator()(int i, float* sums) const {
        sums[0] += 1.0f;
        sums[1] += values[i];
        sums[2] += values[i] * values[i];
    }
};

TEST(SumTiles, IsTheSumForAnyCount) {
    Stream stream;
    for (const int count : {0, 1, 127, 128, 129, 511, 512, 513, 5000}) {
        std::vector<float> values(static_cast<std::size_t>(count));
        double sum = 0, squares = 0;
        for (int i = 0; i < count; ++i) {
            const float v = values[static_cast<std::size_t>(i)] = std::sin(static_cast<float>(i));
            sum += v;
            squares += static_cast<double>(v) * v;
        }
        double sums[3];
        SumTiles<3>(stream, count, AddPowers{values.data()}, nullptr, sums);
        EXPECT_EQ(sums[0], count);
        EXPECT_NEAR(sums[1], sum, 1e-4);
        EXPECT_NEAR(sums[2], squares, 1e-7 * count);
    }
}

// 2^24 + 1 is no float: what is added to 2^24 in single precision is lost, what in double is not.
TEST(SumTiles, AddsInTheStatedOrder) {
    Stream stream;
    const auto sum = [&](int large, int small) {
        std::vector<float> values(2 * kRunItems, 0.0f);
        values[static_cast<std::size_t>(large)] = 16777216.0f;
        values[static_cast<std::size_t>(small)] = 1.0f;
        double sums[3];
        SumTiles<3>(stream, 2 * kRunItems, AddPowers{values.data()}, nullptr, sums);
        return sums[1];
    };
    EXPECT_EQ(sum(0, 1), 16777216.0);           // another lane of the tile
    EXPECT_EQ(sum(0, kTileLanes), 16777216.0);  // the same lane
    EXPECT_EQ(sum(0, kTileItems), 16777217.0);  // another tile
    EXPECT_EQ(sum(0, kRunItems), 16777217.0);   // another run
}

TEST(Atomics, ReturnWhatWasThere) {
    std::int32_t count = 5;
    EXPECT_EQ(AtomicAdd(&count, 3), 5);
    EXPECT_EQ(count, 8);
    std::uint64_t slot = 0;
    EXPECT_EQ(AtomicSwapIf(&slot, std::uint64_t{0}, std::uint64_t{9}), 0u);
    EXPECT_EQ(AtomicSwapIf(&slot, std::uint64_t{0}, std::uint64_t{7}), 9u);
    EXPECT_EQ(slot, 9u);
}

}  // namespace
}  // namespace tessera::serial
