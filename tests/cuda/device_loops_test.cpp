#include "cuda/device_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tessera::host {
namespace {

struct AddPowers {
    const float* values;
    TESSERA_HD_MEMBER void operator()(int i, float* sums) const {
        sums[0] += 1.0f;
        sums[1] += values[i];
        sums[2] += values[i] * values[i];
    }
};

// Device memory is host memory here.
std::array<double, 3> SumOf(const std::vector<float>& values) {
    const auto count = static_cast<int>(values.size());
    std::vector<double> tiles(TileRoom(count, 3));
    std::array<double, 3> sums;
    Stream stream;
    SumTiles<3>(stream, count, AddPowers{values.data()}, tiles.data(), sums.data());
    stream.Wait();
    return sums;
}

TEST(SumTiles, IsTheSumForAnyCount) {
    for (const int count : {0, 1, 127, 128, 129, 511, 512, 513, 5000}) {
        std::vector<float> values(static_cast<std::size_t>(count));
        double sum = 0, squares = 0;
        for (int i = 0; i < count; ++i) {
            const float v = values[static_cast<std::size_t>(i)] = std::sin(static_cast<float>(i));
            sum += v;
            squares += static_cast<double>(v) * v;
        }
        const auto sums = SumOf(values);
        EXPECT_EQ(sums[0], count);
        EXPECT_NEAR(sums[1], sum, 1e-4);
        EXPECT_NEAR(sums[2], squares, 1e-7 * count);
    }
}

// 2^24 + 1 is not a float. Adding 1 to 2^24 is lost in single precision and kept in double.
TEST(SumTiles, AddsInTheStatedOrder) {
    const auto sum = [](int large, int small) {
        std::vector<float> values(2 * kRunItems, 0.0f);
        values[static_cast<std::size_t>(large)] = 16777216.0f;
        values[static_cast<std::size_t>(small)] = 1.0f;
        return SumOf(values)[1];
    };
    EXPECT_EQ(sum(0, 1), 16777216.0);           // another lane of the same tile
    EXPECT_EQ(sum(0, kTileLanes), 16777216.0);  // the same lane
    EXPECT_EQ(sum(0, kTileItems), 16777217.0);  // another tile
    EXPECT_EQ(sum(0, kRunItems), 16777217.0);   // another run
}

struct CountItem {
    std::int32_t* counts;
    TESSERA_HD_MEMBER void operator()(int i) const { ++counts[i]; }
};

TEST(ForEach, CallsEachItemOnceWhenTheStreamIsWaitedFor) {
    for (const int count : {0, 1, 511, 512, 513, 10000}) {
        std::vector<std::int32_t> counts(static_cast<std::size_t>(count) + 1);
        Stream stream;
        ForEach(stream, count, CountItem{counts.data()});
        EXPECT_EQ(std::count(counts.begin(), counts.end(), 0), count + 1);
        stream.Wait();
        EXPECT_EQ(std::count(counts.begin(), counts.end(), 1), count);
        EXPECT_EQ(counts.back(), 0);
    }
}

struct CountInOne {
    std::int32_t* count;
    float *least, *most;
    TESSERA_HD_MEMBER void operator()(int i) const {
        AtomicAdd(count, 1);
        AtomicMin(least, static_cast<float>(i % 1000 + 3));
        AtomicMax(most, static_cast<float>(i % 1000));
    }
};

TEST(Atomics, HoldBetweenThreads) {
    std::int32_t count = 0;
    float least = 1e9f, most = 0;
    Stream stream;
    ForEach(stream, 100000, CountInOne{&count, &least, &most});
    stream.Wait();
    EXPECT_EQ(count, 100000);
    EXPECT_EQ(least, 3.0f);
    EXPECT_EQ(most, 999.0f);
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
}  // namespace tessera::host
