#include "cuda/device.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

namespace tessera::host {
namespace {

TEST(DeviceMemory, CountsAndKeepsItsLimit) {
    DeviceMemory memory(1000);
    void* first = memory.Allocate(600);
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(memory.Allocate(401), nullptr);
    EXPECT_EQ(memory.used_bytes(), 600u);
    memory.Free(first, 600);
    EXPECT_TRUE(memory.HasRoom(1000));
    EXPECT_FALSE(memory.HasRoom(1001));
}

TEST(DeviceBuffer, GrowsWithoutLosingWhatIsToBeKept) {
    DeviceMemory memory(std::size_t{1} << 20);
    Stream stream;
    DeviceBuffer<int> buffer(memory);
    std::vector<int> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), 7);
    ASSERT_TRUE(buffer.Reserve(stream, 1000, 0));
    stream.Upload(buffer.data(), numbers.data(), 4000);
    ASSERT_TRUE(buffer.Reserve(stream, 5000, 900));
    EXPECT_EQ(memory.used_bytes(), 20000u);
    std::vector<int> back(900);
    stream.Download(back.data(), buffer.data(), 3600);
    stream.Wait();
    EXPECT_TRUE(std::equal(back.begin(), back.end(), numbers.begin()));
    EXPECT_FALSE(buffer.Reserve(stream, std::size_t{1} << 20, 900));  // no memory: nothing changes
    EXPECT_EQ(buffer.capacity(), 5000u);
}

TEST(Stream, WhatWasGivenMayBeOverwrittenAndWhatComesIsThereAfterWait) {
    DeviceMemory memory(std::size_t{1} << 28);
    Stream stream;
    DeviceBuffer<std::uint8_t> buffer(memory);
    const std::size_t bytes = (std::size_t{1} << 25) + 123;  // several staging buffers
    ASSERT_TRUE(buffer.Reserve(stream, bytes, 0));
    std::vector<std::uint8_t> sent(bytes), back(bytes), expected(bytes);
    for (std::size_t i = 0; i < bytes; ++i)
        expected[i] = sent[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
    stream.Upload(buffer.data(), sent.data(), bytes);
    std::fill(sent.begin(), sent.end(), std::uint8_t{0});
    stream.Download(back.data(), buffer.data(), bytes);
    stream.Wait();
    EXPECT_EQ(back, expected);
}

TEST(DeviceSorter, SortsKeysAndSelectsIndices) {
    DeviceMemory memory(1 << 20);
    Stream stream;
    DeviceBuffer<std::uint64_t> keys(memory), sorted(memory);
    ASSERT_TRUE(keys.Reserve(stream, 4, 0) && sorted.Reserve(stream, 4, 0));
    const std::uint64_t given[4] = {5, std::uint64_t{1} << 63, 0, 4};
    stream.Upload(keys.data(), given, sizeof given);
    DeviceSorter sorter(memory);
    ASSERT_TRUE(sorter.SortKeys(stream, keys.data(), sorted.data(), 4));
    std::uint64_t back[4];
    stream.Download(back, sorted.data(), sizeof back);
    DeviceBuffer<std::uint8_t> keep(memory);
    DeviceBuffer<std::int32_t> indices(memory), selected(memory);
    ASSERT_TRUE(keep.Reserve(stream, 5, 0) && indices.Reserve(stream, 5, 0) &&
                selected.Reserve(stream, 1, 0));
    const std::uint8_t flags[5] = {0, 1, 1, 0, 9};
    stream.Upload(keep.data(), flags, sizeof flags);
    ASSERT_TRUE(sorter.SelectIndices(stream, keep.data(), 5, indices.data(), selected.data()));
    std::int32_t at[3], count = 0;
    stream.Download(at, indices.data(), sizeof at);
    stream.Download(&count, selected.data(), sizeof count);
    stream.Wait();
    EXPECT_TRUE(back[0] == 0 && back[1] == 4 && back[2] == 5 && back[3] == std::uint64_t{1} << 63);
    EXPECT_EQ(count, 3);
    EXPECT_TRUE(at[0] == 1 && at[1] == 2 && at[2] == 4);
}

TEST(DeviceSorter, SumsWhatIsBefore) {
    DeviceMemory memory(1 << 20);
    Stream stream;
    DeviceBuffer<std::int32_t> counts(memory), sums(memory);
    ASSERT_TRUE(counts.Reserve(stream, 5, 0) && sums.Reserve(stream, 5, 0));
    const std::int32_t given[5] = {3, 0, 7, 1, 0};
    stream.Upload(counts.data(), given, sizeof given);
    DeviceSorter sorter(memory);
    ASSERT_TRUE(sorter.SumBefore(stream, counts.data(), 5, sums.data()));
    std::array<std::int32_t, 5> back;
    stream.Download(back.data(), sums.data(), sizeof back);
    stream.Wait();
    EXPECT_EQ(back, (std::array<std::int32_t, 5>{0, 3, 3, 10, 11}));
}

}  // namespace
}  // namespace tessera::host
