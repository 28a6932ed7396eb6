#include "mapping/block_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "mapping/analytic_fields.h"

namespace tessera {
namespace {

using testing_support::Mix;

BlockCoord RandomCoord(std::uint32_t counter, int range) {
    const auto one = [&](std::uint32_t i) {
        return static_cast<std::int32_t>(Mix(3 * counter + i) %
                                         static_cast<std::uint32_t>(2 * range)) -
               range;
    };
    return {one(0), one(1), one(2)};
}

TEST(BlockMap, StartsWithTheUnknownBlockOnly) {
    const BlockMap map{BlockMap::Config{}};
    EXPECT_EQ(map.size(), 1);
    EXPECT_EQ(map.Find({0, 0, 0}), kUnknownBlock);
    for (int i = 0; i < kBlockVoxels; ++i) ASSERT_EQ(map.field(kUnknownBlock)[i], kUnknownField);
    for (int slot = 0; slot < 8; ++slot) EXPECT_EQ(map.view().neighbours[slot], kUnknownBlock);
}

TEST(BlockMap, NewBlocksAreUnknownAndFoundAgain) {
    BlockMap map{BlockMap::Config{}};
    const BlockId id = map.Allocate({-3, 0, 7});
    EXPECT_EQ(id, 1);
    EXPECT_EQ(map.Allocate({-3, 0, 7}), id);
    EXPECT_EQ(map.Find({-3, 0, 7}), id);
    EXPECT_EQ(map.coord(id), (BlockCoord{-3, 0, 7}));
    EXPECT_EQ(map.Find({3, 0, 7}), kUnknownBlock);
    for (int i = 0; i < kBlockVoxels; ++i) {
        ASSERT_EQ(map.field(id)[i], kUnknownField);
        ASSERT_EQ(map.weight(id)[i], 0);
        ASSERT_EQ(map.colour(id)[i], kNoColour);
    }
    EXPECT_EQ(map.revision(id), 0u);
    map.MarkChanged(id, 42);
    EXPECT_EQ(map.revision(id), 42u);
}

// Far beyond the initial table size, with all signs, up to the limits of a coordinate.
TEST(BlockMap, GrowsToAHundredThousandBlocks) {
    BlockMap map{BlockMap::Config{}};
    std::set<BlockCoord> known;
    for (std::uint32_t i = 0; known.size() < 100000; ++i) {
        const BlockCoord c = RandomCoord(i, i % 2 ? 40 : kBlockLimit);
        const bool is_new = known.insert(c).second;
        const BlockId expected = static_cast<BlockId>(known.size());
        const BlockId id = map.Allocate(c);
        if (is_new) {
            ASSERT_EQ(id, expected) << "ids are assigned in order";
        }
        ASSERT_EQ(map.coord(id), c);
    }
    EXPECT_EQ(map.size(), 100001);
    for (const BlockCoord& c : known) ASSERT_EQ(map.coord(map.Find(c)), c);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const BlockCoord c = RandomCoord(1000000 + i, 60);
        ASSERT_EQ(map.Find(c) != kUnknownBlock, known.count(c) == 1);
    }
    EXPECT_NEAR(map.bytes_per_voxel(), 10.2, 0.3);
    EXPECT_LT(map.bytes_per_voxel(), 12);
}

TEST(BlockMap, NeighbourTableEqualsFind) {
    BlockMap map{BlockMap::Config{}};
    for (std::uint32_t i = 0; i < 3000; ++i) {
        map.Allocate(RandomCoord(i, 8));  // 4096 positions: most neighbours exist, some do not
        if (i % 500 != 499) continue;
        for (BlockId id = 1; id < map.size(); ++id)
            for (int slot = 0; slot < 8; ++slot) {
                const BlockCoord c = map.coord(id);
                const BlockId expected =
                    map.Find({c.x + (slot & 1), c.y + (slot >> 1 & 1), c.z + (slot >> 2)});
                ASSERT_EQ(map.view().neighbours[8 * id + slot], expected);
                ASSERT_EQ(map.neighbour(id, slot & 1, slot >> 1 & 1, slot >> 2), expected);
            }
    }
    const BlockId id = map.Find(map.coord(5));
    const BlockCoord c = map.coord(id);
    EXPECT_EQ(map.neighbour(id, -1, 1, -1), map.Find({c.x - 1, c.y + 1, c.z - 1}));
}

TEST(BlockMap, RefusesCoordinatesBeyondTheLimit) {
    BlockMap map{BlockMap::Config{}};
    EXPECT_EQ(map.Allocate({kBlockLimit, 0, 0}), kUnknownBlock);
    EXPECT_EQ(map.Allocate({0, INT32_MIN, 0}), kUnknownBlock);
    EXPECT_EQ(map.size(), 1);
    const BlockId corner = map.Allocate({kBlockLimit - 1, kBlockLimit - 1, kBlockLimit - 1});
    EXPECT_EQ(corner, 1);
    for (int slot = 1; slot < 8; ++slot) EXPECT_EQ(map.view().neighbours[8 + slot], kUnknownBlock);
    EXPECT_EQ(map.Allocate({-kBlockLimit, -kBlockLimit, -kBlockLimit}), 2);
}

TEST(BlockMap, ClearForgetsEverything) {
    BlockMap map{BlockMap::Config{}};
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const BlockId id = map.Allocate(RandomCoord(i, 20));
        map.field(id)[i % kBlockVoxels] = 0;
        map.weight(id)[i % kBlockVoxels] = 5;
        map.MarkChanged(id, i);
    }
    map.Clear();
    EXPECT_EQ(map.size(), 1);
    for (std::uint32_t i = 0; i < 5000; ++i) ASSERT_EQ(map.Find(RandomCoord(i, 20)), kUnknownBlock);
    EXPECT_TRUE(map.BlocksInRegion({0, 0, 0}).empty());
    const BlockId id = map.Allocate({1, 2, 3});
    EXPECT_EQ(id, 1);
    EXPECT_EQ(map.revision(id), 0u);
    for (int i = 0; i < kBlockVoxels; ++i) {
        ASSERT_EQ(map.field(id)[i], kUnknownField);
        ASSERT_EQ(map.weight(id)[i], 0);
    }
}

// Compares everything that a map returns with the list of blocks it should hold.
void ExpectExactly(const std::map<BlockCoord, std::int32_t>& numbers, const BlockMap& map) {
    ASSERT_EQ(map.count(), static_cast<std::int64_t>(numbers.size()));
    BlockId there = 0;
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id)) {
            ASSERT_EQ(map.revision(id), 0u);
            for (int slot = 0; slot < 8; ++slot)
                ASSERT_EQ(map.view().neighbours[8 * id + slot], kUnknownBlock);
            continue;
        }
        ++there;
        const BlockCoord c = map.coord(id);
        ASSERT_EQ(map.Find(c), id);
        ASSERT_EQ(numbers.at(c), map.number(id));
        for (int slot = 0; slot < 8; ++slot) {
            const BlockCoord other{c.x + (slot & 1), c.y + (slot >> 1 & 1), c.z + (slot >> 2)};
            const BlockId neighbour = map.view().neighbours[8 * id + slot];
            ASSERT_EQ(neighbour != kUnknownBlock, numbers.count(other) == 1);
            if (neighbour != kUnknownBlock) {
                ASSERT_EQ(map.coord(neighbour), other);
            }
        }
        ASSERT_EQ(std::ranges::count(map.BlocksInRegion(RegionOf(c)), id), 1);
    }
    ASSERT_EQ(there, map.count());
}

TEST(BlockMap, ReleasedBlocksAreGoneAndTheirIdsUsedAgain) {
    BlockMap map{BlockMap::Config{}};
    map.EnableLabels();
    std::map<BlockCoord, std::int32_t> numbers;
    std::int32_t allocated = 0;
    BlockId largest = 0;
    for (std::uint32_t i = 0; i < 40000; ++i) {
        const BlockCoord c = RandomCoord(i, i % 3 ? 9 : 14);
        const bool grow = i / 5000 % 2 == 0;  // alternates between growing and shrinking
        if (const BlockId id = map.Find(c); id != kUnknownBlock && Mix(i) % 4 >= (grow ? 3u : 0u)) {
            map.Release(id);
            numbers.erase(c);
            ASSERT_EQ(map.Find(c), kUnknownBlock);
        } else if (id == kUnknownBlock && (grow || i % 8 == 0)) {
            const BlockId added = map.Allocate(c);
            numbers[c] = ++allocated;
            for (int v = 0; v < kBlockVoxels; ++v) {
                ASSERT_EQ(map.field(added)[v], kUnknownField);
                ASSERT_EQ(map.weight(added)[v], 0);
                ASSERT_EQ(map.colour(added)[v], kNoColour);
                ASSERT_EQ(map.label(added)[v].count[0], 0);
            }
            std::fill_n(map.field(added), kBlockVoxels, 7u);
            std::fill_n(map.weight(added), kBlockVoxels, std::uint16_t{7});
            std::fill_n(map.colour(added), kBlockVoxels, 7u);
            map.label(added)[3].count[0] = 7;
            map.MarkChanged(added, i + 1);
            largest = std::max(largest, added);
        }
        if (i % 2500 == 2499) ExpectExactly(numbers, map);
    }
    EXPECT_GT(numbers.size(), 500u);
    EXPECT_EQ(map.size(), largest + 1);
    EXPECT_LT(3 * map.size(), 2 * allocated) << "ids are reused";
    while (!numbers.empty()) {
        map.Release(map.Find(numbers.begin()->first));
        numbers.erase(numbers.begin());
    }
    ExpectExactly(numbers, map);
    EXPECT_EQ(map.Allocate({1, 2, 3}), 1) << "the lowest free id first";
}

TEST(BlockMap, AReleasedBlockComesBackUnderItsNumber) {
    BlockMap map{BlockMap::Config{}};
    for (int i = 0; i < 5; ++i) EXPECT_EQ(map.number(map.Allocate({i, 0, 0})), i + 1);
    map.Release(map.Find({1, 0, 0}));
    map.Release(map.Find({3, 0, 0}));
    EXPECT_EQ(map.number(map.Allocate({9, 0, 0})), 6);
    const BlockId back = map.Allocate({1, 0, 0}, 2);
    EXPECT_EQ(back, 4);
    EXPECT_EQ(map.number(back), 2);
    EXPECT_EQ(map.next_number(), 7);
    map.SetNextNumber(100);
    EXPECT_EQ(map.number(map.Allocate({10, 0, 0})), 100);
}

TEST(BlockMap, NumbersAnewLeaveNoGap) {
    BlockMap map{BlockMap::Config{}};
    for (int i = 0; i < 5; ++i) map.Allocate({i, 0, 0});
    map.Release(map.Find({1, 0, 0}));
    map.Release(map.Find({3, 0, 0}));
    map.Allocate({9, 0, 0});
    map.NumberAnew();
    EXPECT_EQ(map.number(map.Find({0, 0, 0})), 1);
    EXPECT_EQ(map.number(map.Find({9, 0, 0})), 2) << "it has the lowest free id";
    EXPECT_EQ(map.number(map.Find({2, 0, 0})), 3);
    EXPECT_EQ(map.number(map.Find({4, 0, 0})), 4);
    EXPECT_EQ(map.next_number(), 5);
}

TEST(BlockMap, RegionsListTheirBlocks) {
    BlockMap map{BlockMap::Config{}};
    for (std::uint32_t i = 0; i < 20000; ++i) map.Allocate(RandomCoord(i, 30));
    std::size_t listed = 0;
    for (int z = -9; z <= 8; ++z)
        for (int y = -9; y <= 8; ++y)
            for (int x = -9; x <= 8; ++x)
                for (const BlockId id : map.BlocksInRegion({x, y, z})) {
                    ++listed;
                    ASSERT_EQ(RegionOf(map.coord(id)), (BlockCoord{x, y, z}));
                }
    EXPECT_EQ(listed, static_cast<std::size_t>(map.size() - 1));
    EXPECT_EQ(RegionOf({-1, -4, -5}), (BlockCoord{-1, -1, -2}));
    EXPECT_EQ(RegionOf({0, 3, 4}), (BlockCoord{0, 0, 1}));
}

TEST(BlockMap, ConfigWantsABandOfTwoVoxels) {
    BlockMap::Config config;
    EXPECT_TRUE(config.Validate().ok());
    config.voxel_size_m = .03;
    const Status status = config.Validate();
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.message().find("mapping.truncation_m"), std::string::npos);
    EXPECT_NE(status.message().find("0.06"), std::string::npos);
}

}  // namespace
}  // namespace tessera
