#include "mapping/voxel_label.h"

#include <gtest/gtest.h>

#include <random>

namespace tessera {
namespace {

VoxelLabel After(const std::vector<std::uint8_t>& votes, int* flips = nullptr) {
    VoxelLabel v{};
    for (const std::uint8_t vote : votes) {
        const bool flipped = VoteForClass(vote, v);
        if (flips != nullptr) *flips += flipped;
    }
    return v;
}

TEST(VoxelLabel, TwoSlotsTheGreaterFirst) {
    const VoxelLabel v = After({3, 3, 5, 5, 5});
    EXPECT_EQ(v.class_id[0], 5);
    EXPECT_EQ(v.count[0], 3);
    EXPECT_EQ(v.class_id[1], 3);
    EXPECT_EQ(v.count[1], 2);
    EXPECT_EQ(ClassOf(v), 5);
    EXPECT_EQ(ClassOf(After({3})), 0);  // a single vote does not count
    EXPECT_EQ(ClassOf(After({kBackgroundClass, kBackgroundClass})), 0);
}

TEST(VoxelLabel, AThirdClassWearsTheSecondOut) {
    VoxelLabel v = After({1, 1, 1, 2, 3});
    EXPECT_EQ(v.count[1], 0);
    VoteForClass(3, v);
    EXPECT_EQ(v.class_id[1], 3);
    EXPECT_EQ(v.class_id[0], 1);
    EXPECT_EQ(v.count[0], 3);
}

TEST(VoxelLabel, CountersSaturateAndTheSecondThenFades) {
    std::vector<std::uint8_t> votes(300, 1);
    votes.insert(votes.end(), 20, 2);
    VoxelLabel v = After(votes);
    EXPECT_EQ(v.count[0], 255);
    EXPECT_EQ(v.count[1], 20);
    VoteForClass(1, v);
    EXPECT_EQ(v.count[1], 19);
    for (int i = 0; i < 236 + 223; ++i) VoteForClass(2, v);
    EXPECT_EQ(v.class_id[0], 1);
    EXPECT_EQ(v.count[0], 32);
    EXPECT_EQ(v.count[1], 255);
    VoteForClass(2, v);  // now eight times as many
    EXPECT_EQ(v.class_id[0], 2);
}

TEST(VoxelLabel, AFifthOfWrongVotesFlipsNothingSettled) {
    std::mt19937 random(7);
    int flips = 0;
    for (int voxel = 0; voxel < 2000; ++voxel) {
        std::vector<std::uint8_t> votes;
        for (int i = 0; i < 200; ++i)
            votes.push_back(random() % 5 != 0 ? 1 : static_cast<std::uint8_t>(2 + random() % 4));
        EXPECT_EQ(After(votes, &flips).class_id[0], 1);
    }
    EXPECT_EQ(flips, 0);
    std::vector<std::uint8_t> turned(20, 1);  // a lasting change of class does flip
    turned.insert(turned.end(), 160, 2);
    EXPECT_EQ(After(turned, &flips).class_id[0], 1);
    EXPECT_EQ(flips, 0);
    turned.push_back(2);
    EXPECT_EQ(After(turned, &flips).class_id[0], 2);
    EXPECT_EQ(flips, 1);
    turned.assign(20, 1);  // background is separated from objects by majority
    turned.insert(turned.end(), 21, kBackgroundClass);
    EXPECT_EQ(ClassOf(After(turned)), 0);
}

TEST(VoxelLabel, InstancesByMajority) {
    VoxelLabel v{};
    VoteForInstance(7, v);
    VoteForInstance(7, v);
    VoteForInstance(9, v);
    EXPECT_EQ(v.instance, 7);
    VoteForInstance(0, v);
    EXPECT_EQ(v.instance, 0);
    VoteForInstance(9, v);
    EXPECT_EQ(v.instance, 9);
}

}  // namespace
}  // namespace tessera
