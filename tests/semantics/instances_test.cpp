#include "semantics/instances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "semantics/observed_objects.h"

namespace tessera {
namespace {

TEST(Instances, NewThenUpdatedThenConfirmed) {
    Instances instances({.min_observations = 3, .min_rate = 0.3});
    const InstanceId id = instances.Match({Seen(5)}, {})[0];
    EXPECT_NE(id, 0);
    EXPECT_FALSE(instances.confirmed(id));
    for (int i = 0; i < 2; ++i)
        EXPECT_EQ(instances.Match({Seen(5, {{id, 90}})}, {{id, {95}}})[0], id);
    EXPECT_TRUE(instances.confirmed(id));
    EXPECT_EQ(instances.record(id).public_id, 1);
    EXPECT_EQ(instances.record(id).observations, 3);
    EXPECT_NEAR(instances.Probability(id), 0.9, 1e-6);
}

TEST(Instances, TwoOfAClassStayApart) {
    Instances instances({.min_observations = 3, .min_rate = 0.3});
    const auto both = instances.Match({Seen(5), Seen(5)}, {});
    EXPECT_NE(both[0], both[1]);
    for (int i = 0; i < 9; ++i)
        EXPECT_EQ(
            instances.Match({Seen(5, {{both[1], 80}, {both[0], 5}}), Seen(5, {{both[0], 85}})},
                            {{both[0], {90}}, {both[1], {90}}}),
            (std::vector<InstanceId>{both[1], both[0]}));
    EXPECT_EQ(instances.record(both[0]).public_id + instances.record(both[1]).public_id, 3);
}

TEST(Instances, AWrongClassIsAVoteAndNotAnotherObject) {
    Instances instances({});
    const InstanceId id = Confirmed(instances, 5);
    EXPECT_EQ(instances.Match({Seen(4, {{id, 90}})}, {{id, {95}}})[0], id);
    EXPECT_EQ(instances.ClassOf(id), 5);
    EXPECT_EQ(instances.last(), id);
    for (int i = 0; i < 20; ++i) instances.Match({Seen(4, {{id, 90}})}, {{id, {95}}});
    EXPECT_EQ(instances.ClassOf(id), 4);  // the new class has more votes in the end
    EXPECT_EQ(instances.record(id).public_id, 1);
}

TEST(Instances, ABusyRegionThatFitsNothingSaysNothing) {
    Instances instances({});
    const InstanceId a = Confirmed(instances, 5), b = Confirmed(instances, 5);
    // Half on one and half on another large object of its class: it matches neither and creates no
    // new object.
    EXPECT_EQ(instances.Match({Seen(5, {{a, 35}, {b, 30}})}, {{a, {1000}}, {b, {1000}}})[0], 0);
}

TEST(Instances, WhatIsSeldomSeenIsDropped) {
    Instances instances({});
    const InstanceId id = instances.Match({Seen(5)}, {})[0];
    for (int i = 0; i < 12; ++i) instances.Match({}, {{id, {95}}});
    EXPECT_EQ(instances.Resolve(id), 0);
    const InstanceId kept = Confirmed(instances, 5);
    for (int i = 0; i < 100; ++i) instances.Match({}, {{kept, {95}}});
    EXPECT_EQ(instances.Resolve(kept), kept);  // a confirmed object is kept,
    EXPECT_FALSE(instances.stands(kept));      // but it is not shown
    for (int i = 0; i < 30; ++i) instances.Match({Seen(5, {{kept, 90}})}, {{kept, {95}}});
    EXPECT_TRUE(instances.stands(kept));
    EXPECT_EQ(instances.record(kept).public_id, 1);
}

TEST(Instances, TwoThatAreOneAreJoinedUnderTheOlderNumber) {
    Instances instances({});
    const InstanceId a = Confirmed(instances, 5), b = Confirmed(instances, 5);
    ASSERT_NE(a, b);
    EXPECT_EQ(instances.record(b).public_id, 2);
    const int before = instances.record(a).observations + instances.record(b).observations;
    for (int i = 0; i < 12; ++i) {
        EXPECT_EQ(instances.Resolve(b), b) << i;
        instances.Match({Seen(5, {{a, 50}, {b, 48}})}, {{a, {55}}, {b, {55}}});
    }
    EXPECT_EQ(instances.Resolve(b), a);
    EXPECT_EQ(instances.record(a).public_id, 1);
    EXPECT_EQ(instances.record(a).observations, before + 12);
}

TEST(Instances, DetectionsApartSpeakAgainstJoining) {
    Instances instances({});
    const InstanceId a = Confirmed(instances, 5), b = Confirmed(instances, 5);
    for (int i = 0; i < 20; ++i) {
        instances.Match({Seen(5, {{a, 50}, {b, 10}}), Seen(5, {{b, 50}})}, {{a, {55}}, {b, {55}}});
        if (i % 3 == 0) instances.Match({Seen(5, {{a, 50}, {b, 48}})}, {{a, {55}}, {b, {55}}});
    }
    EXPECT_EQ(instances.Resolve(b), b);
}

Eigen::AlignedBox2d Pixels(double x_min, double y_min, double x_max, double y_max) {
    return {Eigen::Vector2d(x_min, y_min), Eigen::Vector2d(x_max, y_max)};
}

// A book lies on another book. The box and segment of the lower one cover both. In a frame in which
// the upper one is missed, the outline identifies the lower one, and the upper one keeps its
// voxels.
TEST(Instances, ADetectionIsTheOneWithItsOutlineAndSparesTheOneItCovers) {
    Instances instances({});
    const InstanceId upper = Confirmed(instances, 5), lower = Confirmed(instances, 5);
    const std::map<InstanceId, VisibleObject> visible{{upper, {200, Pixels(10, 0, 90, 40)}},
                                                      {lower, {90, Pixels(0, 0, 100, 60)}}};
    ObservedObject seen = Seen(5, {{upper, 170}, {lower, 85}}, 290);
    seen.image_box = Pixels(0, 0, 100, 60);
    const std::vector<InstanceId> match = instances.Match({seen}, visible);
    EXPECT_EQ(match[0], lower);
    EXPECT_EQ(instances.Covered(seen, visible, match), std::vector<InstanceId>{upper});
    ObservedObject other = Seen(5, {{upper, 195}}, 220);
    other.image_box = Pixels(10, 0, 90, 40);
    const std::vector<InstanceId> both = instances.Match({seen, other}, visible);
    EXPECT_EQ(both, (std::vector<InstanceId>{lower, upper}));
    EXPECT_TRUE(instances.Covered(seen, visible, both).empty());
}

// All its voxels still belong to another object. It is recognised by its position instead of
// becoming a new object in every frame.
TEST(Instances, WhatTheMapDoesNotShowYetIsKnownByItsPlace) {
    Instances instances({});
    const InstanceId a = Confirmed(instances, 5);
    ObservedObject beside = Seen(5, {{a, 50}}, 60);
    beside.box = {Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(4, 1, 1)};
    const InstanceId b = instances.Match({Seen(5, {{a, 90}}), beside}, {{a, {150}}})[1];
    ASSERT_NE(b, a);
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(instances.Match({Seen(5, {{a, 90}}), beside}, {{a, {150}}})[1], b);
    beside.box.translate(Eigen::Vector3d(3, 0, 0));
    EXPECT_NE(instances.Match({Seen(5, {{a, 90}}), beside}, {{a, {150}}})[1], b);
}

ObservedObject SeenLike(std::map<InstanceId, int> overlaps, std::vector<double> embedding,
                        float probability) {
    ObservedObject o = Seen(5, std::move(overlaps));
    o.probability = probability;
    o.embedding = std::move(embedding);
    return o;
}

TEST(Instances, AnEmbeddingIsTheWeightedMeanOfItsDetections) {
    Instances instances({});
    const InstanceId id = instances.Match({SeenLike({}, {1, 0, 0}, 1.0f)}, {})[0];
    EXPECT_EQ(instances.Embedding(id), (std::vector<float>{1, 0, 0}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const std::vector<double>& embedding :
         {std::vector<double>{0, 8, 0}, {}, {1, 2}, {nan, 0, 0}})
        ASSERT_EQ(instances.Match({SeenLike({{id, 90}}, embedding, 0.5f)}, {{id, {95}}})[0], id);
    // (1, 0, 0) + 0.5 (0, 8, 0); the others have no length of 3, or are not finite.
    const std::vector<float> mean = instances.Embedding(id);
    ASSERT_EQ(mean.size(), 3u);
    EXPECT_NEAR(mean[0], 1 / std::sqrt(17.0), 1e-6);
    EXPECT_NEAR(mean[1], 4 / std::sqrt(17.0), 1e-6);
}

TEST(Instances, EmbeddingsAreSavedAndAnOlderStateHasNone) {
    Instances instances({}), older({});
    const InstanceId id = instances.Match({SeenLike({}, {3, 4}, 1.0f), Seen(7)}, {})[0];
    older.Match({Seen(5), Seen(7)}, {});
    std::vector<std::uint8_t> bytes, older_bytes;
    StateWriter writer(bytes), older_writer(older_bytes);
    instances.SaveState(writer);
    older.SaveState(older_writer);
    EXPECT_LT(older_bytes.size(), bytes.size());
    Instances resumed({});
    StateReader reader(bytes), older_reader(older_bytes);
    ASSERT_TRUE(resumed.LoadState(reader));
    EXPECT_EQ(resumed.Embedding(id), (std::vector<float>{0.6f, 0.8f}));
    ASSERT_TRUE(resumed.LoadState(older_reader));
    EXPECT_TRUE(resumed.Embedding(id).empty());
    // Cut anywhere but where an older state ends, it is refused.
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        StateReader cut(std::span<const std::uint8_t>(bytes).first(size));
        EXPECT_EQ(Instances({}).LoadState(cut), size == older_bytes.size()) << size;
    }
}

}  // namespace
}  // namespace tessera
