#include "mapping/virtual_array.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace tessera {
namespace {

TEST(VirtualArray, ReadsZeroUntilWrittenAndNeverMoves) {
    VirtualArray<std::uint32_t> array(std::size_t{1} << 30);  // 4 GB of address space only
    ASSERT_GE(array.max_size(), std::size_t{1} << 20);
    const std::uint32_t* data = array.data();
    const std::size_t last = array.max_size() - 1;
    EXPECT_EQ(array[0], 0u);
    EXPECT_EQ(array[last], 0u);
    array[0] = 7;
    array[last] = 9;
    EXPECT_EQ(array.data(), data);
    EXPECT_EQ(array[0], 7u);
    EXPECT_EQ(array[last], 9u);
    EXPECT_EQ(array[last / 2], 0u);
}

TEST(VirtualArray, ClearMakesZeros) {
    VirtualArray<std::uint16_t> array(1 << 20);
    for (std::size_t i = 0; i < array.max_size(); i += 100) array[i] = 1;
    array.Clear();
    for (std::size_t i = 0; i < array.max_size(); i += 100) ASSERT_EQ(array[i], 0);
    array[5] = 3;
    EXPECT_EQ(array[5], 3);
}

// A request larger than any address space is halved until it succeeds.
TEST(VirtualArray, AsksForLessWhenRefused) {
    VirtualArray<std::uint64_t> array(std::size_t{1} << 50);
    EXPECT_GT(array.max_size(), 1u << 20);
    EXPECT_LT(array.max_size(), std::size_t{1} << 50);
    array[0] = 1;
    array[array.max_size() - 1] = 1;
}

}  // namespace
}  // namespace tessera
