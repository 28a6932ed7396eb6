#include "recordings/lzfse_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "recordings/lzfse.h"

namespace tessera {
namespace {

using Bytes = std::vector<std::uint8_t>;

bool BlockDecodes(const Bytes& stream, const Bytes& expected) {
    Bytes bytes(expected.size());
    return DecodeLzfse(stream, bytes) && bytes == expected;
}

struct HandMade {
    std::uint8_t bytes = 0, literals = 0, steps = 0;
    std::uint8_t literal_bytes = 0, step_bytes = 0;  // all zero
    bool literals_take_bits = false, steps_take_bits = false;
};

// A block of steps of one literal, 'A', each. One bit for each literal or step, or none at all.
Bytes StreamOf(const HandMade& block) {
    Bytes stream(772);
    std::copy_n("bvx1", 4, stream.begin());
    stream[4] = block.bytes;
    stream[12] = block.literals;
    stream[16] = block.steps;
    stream[20] = block.literal_bytes;
    stream[24] = block.step_bytes;
    stream[50 + 2] = block.steps_take_bits ? 32 : 64;  // states of a run of one literal,
    stream[50 + 4] = block.steps_take_bits ? 32 : 0;   // of two,
    stream[90] = 64;                                   // of no match,
    stream[130 + 1] = 1;                               // 256 of the distance before,
    stream[258 + 2 * 'A' + 1] = block.literals_take_bits ? 2 : 4;  // and 512 or 1024 of 'A'
    stream[258 + 2 * 'B' + 1] = block.literals_take_bits ? 2 : 0;
    stream.resize(stream.size() + block.literal_bytes + block.step_bytes);
    std::copy_n("bvx$", 4, std::back_inserter(stream));
    return stream;
}

TEST(LzfseBlock, HoldsWhatItsHeaderSays) {
    EXPECT_TRUE(BlockDecodes(StreamOf({5, 8, 5}), Bytes(5, 'A')));
    EXPECT_FALSE(BlockDecodes(StreamOf({6, 8, 5}), Bytes(5, 'A')));
    EXPECT_FALSE(BlockDecodes(StreamOf({5, 4, 5}), Bytes(5, 'A')));
    EXPECT_TRUE(BlockDecodes(StreamOf({8, 8, 8, 1, 0, true, false}), Bytes(8, 'A')));
    EXPECT_FALSE(BlockDecodes(StreamOf({9, 12, 9, 1, 0, true, false}), Bytes(9, 'A')));
    EXPECT_TRUE(BlockDecodes(StreamOf({8, 8, 8, 0, 1, false, true}), Bytes(8, 'A')));
    EXPECT_FALSE(BlockDecodes(StreamOf({9, 12, 9, 0, 1, false, true}), Bytes(9, 'A')));
}

// Four billion steps that write nothing and take no bits.
TEST(LzfseBlock, EmptyStepsAreRefused) {
    Bytes stream = StreamOf({});
    std::fill_n(stream.begin() + 16, 4, std::uint8_t{255});
    std::swap(stream[50], stream[52]);
    Bytes nothing;
    EXPECT_EQ(LzfseSize(stream), 0u);
    EXPECT_FALSE(DecodeLzfse(stream, nothing));
}

}  // namespace
}  // namespace tessera
