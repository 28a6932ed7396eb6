#include "render/range_pool.h"

#include <gtest/gtest.h>

#include "mapping/analytic_fields.h"

namespace tessera {
namespace {

TEST(RangePool, SizesAreEnoughAndWasteAtMostAFifth) {
    for (std::uint32_t count = 1; count < 5000; ++count) {
        RangePool pool;
        const RangePool::Range range = pool.Allocate(count);
        ASSERT_GE(range.size, count);
        if (count >= 16) {
            ASSERT_LE(range.size, count + count / 4) << count;
        }
        ASSERT_TRUE(RangePool::Fits(range, count));
        ASSERT_TRUE(RangePool::Fits(range, range.size));
        ASSERT_FALSE(RangePool::Fits(range, range.size + 1));
    }
}

TEST(RangePool, NothingNeedsNothing) {
    RangePool pool;
    RangePool::Range range = pool.Allocate(0);
    EXPECT_EQ(range.size, 0u);
    EXPECT_TRUE(RangePool::Fits(range, 0));
    EXPECT_FALSE(RangePool::Fits(range, 1));
    pool.Free(range);
    EXPECT_EQ(pool.end(), 0u);
    EXPECT_EQ(pool.used(), 0u);
}

// Two hundred blocks change their sizes randomly. They must never overlap, and the pool must stop
// growing.
TEST(RangePool, ReusesWhatWasGivenBack) {
    RangePool pool;
    std::vector<RangePool::Range> ranges(200);
    std::uint32_t counter = 0, end_halfway = 0;
    for (int round = 0; round < 200; ++round) {
        for (RangePool::Range& range : ranges) {
            pool.Free(range);
            range = pool.Allocate(testing_support::Mix(++counter) % 300);
        }
        if (round == 100) end_halfway = pool.end();
    }
    EXPECT_LT(pool.end(), end_halfway + end_halfway / 10);
    EXPECT_LT(pool.end(), 3 * pool.used());
    std::vector<char> taken(pool.end());
    std::uint32_t used = 0;
    for (const RangePool::Range& range : ranges) {
        used += range.size;
        for (std::uint32_t i = 0; i < range.size; ++i) {
            ASSERT_FALSE(taken[range.first + i]);
            taken[range.first + i] = 1;
        }
    }
    EXPECT_EQ(used, pool.used());
    for (RangePool::Range& range : ranges) pool.Free(range);
    EXPECT_EQ(pool.used(), 0u);
}

}  // namespace
}  // namespace tessera
