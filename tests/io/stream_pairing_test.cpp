#include "io/stream_pairing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "io/stamp_pairing.h"

namespace tessera {
namespace {

struct Stamp {
    bool depth;
    double stamp_s;
};

// The low bits of a whole number of milliseconds.
std::uint8_t Low8(double ms) { return static_cast<std::uint8_t>(static_cast<int>(ms)); }

// The pairs returned while the images `arriving` are pushed. Each image carries its stamp in
// milliseconds.
std::vector<std::pair<double, double>> Feed(StreamPairing& pairing,
                                            const std::vector<Stamp>& arriving, bool end = true) {
    std::vector<std::pair<double, double>> pairs;
    StreamPairing::Pair pair;
    const auto take = [&] {
        while (pairing.Next(pair)) {
            EXPECT_EQ(pair.depth(0, 0),
                      static_cast<std::uint16_t>(1000 * pair.depth_stamp_s + 0.5));
            EXPECT_EQ(pair.colour(0, 0).r, Low8(1000 * pair.colour_stamp_s + 0.5));
            pairs.emplace_back(pair.depth_stamp_s, pair.colour_stamp_s);
        }
    };
    for (const Stamp& s : arriving) {
        Image<std::uint16_t> depth(1, 1, static_cast<std::uint16_t>(1000 * s.stamp_s + 0.5));
        ColourImage colour(1, 1, {Low8(1000 * s.stamp_s + 0.5), 0, 0});
        if (s.depth)
            pairing.AddDepth(s.stamp_s, depth);
        else
            pairing.AddColour(s.stamp_s, colour);
        take();
    }
    if (end) pairing.End();
    take();
    return pairs;
}

using Pairs = std::vector<std::pair<double, double>>;

TEST(StreamPairing, APairIsGivenAtOnceIfNoneNearerCanCome) {
    StreamPairing pairing(0.02, 0.033);
    EXPECT_EQ(Feed(pairing, {{true, 1.0}, {false, 1.004}}, false), (Pairs{{1.0, 1.004}}));
    EXPECT_EQ(Feed(pairing, {{false, 1.035}, {true, 1.033}}, false), (Pairs{{1.033, 1.035}}));
}

TEST(StreamPairing, AFarOneWaitsForANearerOne) {
    StreamPairing pairing(0.03, 0.033);
    EXPECT_EQ(Feed(pairing, {{false, 1.0}, {true, 1.025}}, false), Pairs{});
    EXPECT_EQ(Feed(pairing, {{false, 1.028}}, false), (Pairs{{1.025, 1.028}}));
    EXPECT_EQ(pairing.colour_alone(), 1);
}

TEST(StreamPairing, AGapOfTheLimitIsNoPair) {
    StreamPairing pairing(0.25, 1);
    EXPECT_EQ(Feed(pairing, {{true, 1.0}, {false, 1.25}, {true, 2.0}, {false, 2.125}}),
              (Pairs{{2.0, 2.125}}));
    EXPECT_EQ(pairing.depth_alone(), 1);
    EXPECT_EQ(pairing.colour_alone(), 1);
    EXPECT_EQ(pairing.pairs(), 1);
}

TEST(StreamPairing, AStreamThatEndsLeavesNothingWaitingForever) {
    StreamPairing pairing(0.02, 0.033);
    std::vector<Stamp> arriving;
    for (int i = 0; i < 100; ++i) arriving.push_back({true, 1 + 0.033 * i});
    EXPECT_EQ(Feed(pairing, arriving, false), Pairs{});
    EXPECT_GE(pairing.depth_alone(), 90);
    arriving.clear();
    for (int i = 0; i < 100; ++i) arriving.push_back({false, 10 + 0.033 * i});
    Feed(pairing, arriving, false);
    EXPECT_GE(pairing.colour_alone(), 90);
}

TEST(StreamPairing, ClearForgetsWhatWaits) {
    StreamPairing pairing(0.02, 0.033);
    Feed(pairing, {{true, 1.0}}, false);
    pairing.Clear();
    EXPECT_EQ(Feed(pairing, {{false, 1.0}}), Pairs{});
    EXPECT_EQ(pairing.depth_alone(), 0);
}

// With jitter, losses and different rates, the pairs equal those of pairing the whole lists
// afterwards. In the last rounds images lie halfway between two partners, and only the invariants
// are checked.
TEST(StreamPairing, AgreesWithThePairingOfWholeLists) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-0.004, 0.004), share(0, 1);
    for (int round = 0; round < 50; ++round) {
        const bool halfway = round >= 40;
        const double offset_s = halfway ? 1 / 60.0 : 0.012 * (2 * share(random) - 1);
        const int colour_every = 1 + round % 3;
        std::vector<double> depth, colour;
        for (int i = 0; i < 60; ++i) {
            if (share(random) > 0.1) depth.push_back(1 + i / 30.0 + jitter(random));
            if (i % colour_every == 0 && share(random) > 0.1)
                colour.push_back(1 + offset_s + i / 30.0 + jitter(random));
        }
        std::vector<Stamp> arriving;
        for (const double s : depth) arriving.push_back({true, s});
        for (const double s : colour) arriving.push_back({false, s});
        std::ranges::sort(arriving, {}, &Stamp::stamp_s);
        Pairs expected;
        for (const StampPair& p : PairNearest(depth, colour, 0.02))
            expected.emplace_back(depth[p.depth], colour[p.colour]);
        StreamPairing pairing(0.02, 1 / 30.0 - 0.008);
        const Pairs pairs = Feed(pairing, arriving);
        if (!halfway) {
            EXPECT_EQ(pairs, expected) << "round " << round;
        }
        EXPECT_NEAR(static_cast<double>(pairs.size()), static_cast<double>(expected.size()), 4);
        for (const auto& [depth_s, colour_s] : pairs) EXPECT_LT(std::abs(depth_s - colour_s), 0.02);
        EXPECT_EQ(pairing.pairs() + pairing.depth_alone(), static_cast<std::int64_t>(depth.size()));
        EXPECT_EQ(pairing.pairs() + pairing.colour_alone(),
                  static_cast<std::int64_t>(colour.size()));
    }
}

}  // namespace
}  // namespace tessera
