// How instances are saved, and the limit of their number.
#include <gtest/gtest.h>

#include <cstring>

#include "semantics/observed_objects.h"

namespace tessera {
namespace {

TEST(Instances, GoOnFromASavedState) {
    Instances instances({});
    const InstanceId a = Confirmed(instances, 5);
    instances.Match({Seen(4), Seen(5, {{a, 90}})}, {{a, {95}}});
    std::vector<std::uint8_t> bytes;
    StateWriter writer(bytes);
    instances.SaveState(writer);
    Instances resumed({});
    StateReader reader(bytes);
    ASSERT_TRUE(resumed.LoadState(reader));
    for (int i = 0; i < 8; ++i) {
        const std::vector<ObservedObject> seen{Seen(5, {{a, 90}}),
                                               Seen(4, {{InstanceId(a + 1), 80}})};
        const std::map<InstanceId, VisibleObject> visible{{a, {95}}, {InstanceId(a + 1), {90}}};
        EXPECT_EQ(resumed.Match(seen, visible), instances.Match(seen, visible));
    }
    EXPECT_EQ(resumed.last(), instances.last());
    EXPECT_EQ(resumed.record(InstanceId(a + 1)).public_id, 2);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        StateReader cut(std::span<const std::uint8_t>(bytes).first(size));
        EXPECT_FALSE(Instances({}).LoadState(cut)) << size;
    }
}

// The state of instances without detections, joined like this; the first entry is that of number 0.
std::vector<std::uint8_t> StateOf(const std::vector<InstanceId>& merged_into) {
    std::vector<std::uint8_t> none, state;
    StateWriter writer(none), all(state);
    Instances({}).SaveState(writer);
    // A count, the record of number 0, and the counts of evidence and public numbers.
    std::vector<std::uint8_t> record(none.begin() + 8, none.end() - 12);
    all.Put(static_cast<std::uint64_t>(merged_into.size()));
    for (const InstanceId into : merged_into) {
        std::memcpy(record.data() + record.size() - 4, &into, 2);
        state.insert(state.end(), record.begin(), record.end());
    }
    state.insert(state.end(), none.end() - 12, none.end());
    return state;
}

bool Loads(const std::vector<std::uint8_t>& state, Instances& instances) {
    StateReader reader(state);
    return instances.LoadState(reader);
}

// The newer part of an object was confirmed first, so both get its number.
TEST(Instances, AnOlderPartThatWasJoinedToANewerOneIsSaved) {
    Instances instances({}), resumed({});
    const InstanceId older = instances.Match({Seen(5)}, {})[0];
    const InstanceId newer = Confirmed(instances, 5);
    ASSERT_LT(older, newer);
    for (int i = 0; i < 12; ++i)
        instances.Match({Seen(5, {{older, 50}, {newer, 48}})}, {{older, {55}}, {newer, {55}}});
    ASSERT_EQ(instances.Resolve(older), newer);
    std::vector<std::uint8_t> state;
    StateWriter writer(state);
    instances.SaveState(writer);
    ASSERT_TRUE(Loads(state, resumed));
    EXPECT_EQ(resumed.Resolve(older), newer);
    EXPECT_EQ(resumed.record(newer).observations, instances.record(newer).observations);
}

TEST(Instances, JoinsWithoutAnEndAreRefused) {
    Instances instances({});
    ASSERT_TRUE(Loads(StateOf({0, 4, 0, 2, 3}), instances));
    EXPECT_EQ(instances.Resolve(1), 2);
    for (const std::vector<InstanceId>& merged_into :
         std::vector<std::vector<InstanceId>>{{0, 1}, {0, 2, 1}, {0, 2, 3, 4, 2}, {0, 2}, {1, 0}})
        EXPECT_FALSE(Loads(StateOf(merged_into), instances)) << merged_into.size();
    EXPECT_EQ(instances.last(), 4);
}

TEST(Instances, TheLastNumberIsUsedAndThenThereIsNone) {
    Instances instances({});
    ASSERT_TRUE(Loads(StateOf(std::vector<InstanceId>(65535, 0)), instances));
    const InstanceId id = Confirmed(instances, 5);
    EXPECT_EQ(id, 65535);
    EXPECT_EQ(instances.record(id).public_id, 1);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(instances.Match({Seen(5)}, {})[0], 0);
    EXPECT_EQ(instances.last(), 65535);
    EXPECT_EQ(instances.record(id).observations, 13);
    Instances again({});
    again.KeepNumbersOf(instances);
    instances.KeepNumbersOf(again);
    EXPECT_EQ(instances.record(id).public_id, 2);  // it shares no detections with another
}

}  // namespace
}  // namespace tessera
