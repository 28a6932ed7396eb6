#include "optimize/place_index.h"

#include <gtest/gtest.h>

#include <random>

namespace tessera {
namespace {

std::vector<Descriptor> Random(std::mt19937_64& random, int count) {
    std::vector<Descriptor> descriptors(static_cast<std::size_t>(count));
    for (Descriptor& d : descriptors)
        for (std::uint64_t& word : d) word = random();
    return descriptors;
}

void Flip(std::mt19937_64& random, int bits, Descriptor& d) {
    for (int i = 0; i < bits; ++i) {
        const std::uint64_t bit = random() % 256;
        d[bit / 64] ^= std::uint64_t{1} << (bit % 64);
    }
}

class Places : public testing::Test {
  protected:
    Places() {
        for (int k = 0; k < 30; ++k) {
            places.push_back(Random(random, 300));
            index.Add(k, places.back());
        }
    }
    std::mt19937_64 random{5};
    std::vector<std::vector<Descriptor>> places;
    PlaceIndex index;
};

TEST_F(Places, TheSameFeaturesAllVote) {
    const auto found = index.Query(places[11], 30, 3, 5);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0], (PlaceIndex::Candidate{11, 300}));
}

TEST_F(Places, AThirdOfTheFeaturesWithATenthOfTheirBitsWrongIsEnough) {
    std::vector<Descriptor> query = Random(random, 200);
    for (std::size_t i = 0; i < 100; ++i) {
        query.push_back(places[4][i]);
        Flip(random, 26, query.back());
    }
    const auto found = index.Query(query, 30, 3, 10);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].keyframe, 4);
    EXPECT_GT(found[0].votes, 60);
}

TEST_F(Places, AnUnknownPlaceHasNoVotes) {
    EXPECT_TRUE(index.Query(Random(random, 300), 30, 3, 1).empty());
}

// What is seen everywhere, such as a blank wall, tells no place from another.
TEST(PlaceIndex, WhatMoreThanFourHundredFeaturesLookLikeDoesNotVote) {
    std::mt19937_64 random(7);
    const std::vector<Descriptor> one = Random(random, 1);
    PlaceIndex index;
    index.Add(0, std::vector<Descriptor>(399, one[0]));
    index.Add(2, one);  // keyframe 1 has no features
    const std::vector<PlaceIndex::Candidate> both{{0, 1}, {2, 1}};
    EXPECT_EQ(index.Query(one, 3, 5, 1), both);
    index.Add(3, one);
    EXPECT_TRUE(index.Query(one, 3, 5, 1).empty());
}

TEST_F(Places, RecentOnesAreLeftOutAndTheBestComeFirst) {
    std::vector<Descriptor> query(places[20].begin(), places[20].begin() + 50);
    query.insert(query.end(), places[3].begin(), places[3].begin() + 80);
    query.insert(query.end(), places[7].begin(), places[7].begin() + 80);
    const std::vector<PlaceIndex::Candidate> all{{3, 80}, {7, 80}, {20, 50}};
    EXPECT_EQ(index.Query(query, 30, 5, 5), all);
    EXPECT_EQ(index.Query(query, 20, 5, 5), (std::vector<PlaceIndex::Candidate>{{3, 80}, {7, 80}}));
    EXPECT_EQ(index.Query(query, 30, 1, 5), (std::vector<PlaceIndex::Candidate>{{3, 80}}));
    EXPECT_EQ(index.Query(query, 30, 5, 60).size(), 2u);
}

}  // namespace
}  // namespace tessera
