// Objects keep their numbers when the map is rebuilt (Instances::KeepNumbersOf).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "semantics/observed_objects.h"

namespace tessera {
namespace {

// Two objects seen one after the other. Each detection has its own mark.
Instances TwoObjects(const std::vector<std::uint64_t>& first,
                     const std::vector<std::uint64_t>& second, bool swapped) {
    Instances instances({.min_observations = 3, .min_rate = 0.3});
    std::vector<std::pair<std::uint64_t, bool>> detections;
    for (const std::uint64_t mark : first) detections.emplace_back(mark, false);
    for (const std::uint64_t mark : second) detections.emplace_back(mark, true);
    if (swapped) std::ranges::reverse(detections);
    InstanceId known[2] = {0, 0};
    for (const auto& [mark, is_second] : detections) {
        InstanceId& id = known[is_second];
        ObservedObject seen =
            Seen(is_second ? 6 : 5,
                 id == 0 ? std::map<InstanceId, int>{} : std::map<InstanceId, int>{{id, 90}});
        seen.box.translate(Eigen::Vector3d(is_second ? 5 : 0, 0, 0));
        seen.mark = mark;
        id = instances.Match({seen}, id == 0 ? std::map<InstanceId, VisibleObject>{}
                                             : std::map<InstanceId, VisibleObject>{{id, {95}}})[0];
    }
    return instances;
}

int NumberOfClass(const Instances& instances, int class_id) {
    for (const InstanceId id : instances.ids())
        if (instances.ClassOf(id) == class_id) return instances.record(id).public_id;
    return 0;
}

TEST(InstanceNumbers, MadeAgainOfPartOfTheDetectionsTheyKeepTheirNumbers) {
    std::vector<std::uint64_t> first, second, some_first, some_second;
    for (std::uint64_t i = 1; i <= 400; ++i) {
        (i % 3 != 0 ? first : second).push_back(i * 0x9e3779b97f4a7c15u);
        if (i % 8 < 2) (i % 3 != 0 ? some_first : some_second).push_back(i * 0x9e3779b97f4a7c15u);
    }
    const Instances before = TwoObjects(first, second, false);
    ASSERT_EQ(NumberOfClass(before, 5), 1);
    ASSERT_EQ(NumberOfClass(before, 6), 2);
    Instances after = TwoObjects(some_first, some_second, true);
    ASSERT_EQ(NumberOfClass(after, 5), 2);
    after.KeepNumbersOf(before);
    EXPECT_EQ(NumberOfClass(after, 5), 1);
    EXPECT_EQ(NumberOfClass(after, 6), 2);
    EXPECT_EQ(after.record(Confirmed(after, 7)).public_id, 3);
}

TEST(InstanceNumbers, OneThatIsConfirmedLaterStillGetsItsNumber) {
    std::vector<std::uint64_t> marks{10, 20, 30, 40, 50};
    const Instances before = TwoObjects({1, 2, 3}, marks, false);
    ASSERT_EQ(NumberOfClass(before, 6), 2);
    Instances after = TwoObjects({}, {10, 20}, false);
    after.KeepNumbersOf(before);
    EXPECT_EQ(NumberOfClass(after, 6), 0);
    ObservedObject seen = Seen(6, {{1, 90}});
    after.Match({seen}, {{1, {95}}});
    EXPECT_EQ(NumberOfClass(after, 6), 2);
    Instances strangers = TwoObjects({}, {11, 21, 31}, false);
    strangers.KeepNumbersOf(before);
    EXPECT_EQ(NumberOfClass(strangers, 6), 3);  // 1 and 2 belong to other objects
}

// Two objects of a class, five metres apart, each seen eight times while the map shows neither. The
// marks of their detections start at `marks`.
std::array<InstanceId, 2> Parts(Instances& instances, const std::array<std::uint64_t, 2>& marks) {
    std::array<InstanceId, 2> parts{};
    for (std::size_t part : {0u, 1u}) {
        ObservedObject seen = Seen(5);
        seen.box.translate(Eigen::Vector3d(5.0 * static_cast<double>(part), 0, 0));
        for (std::uint64_t i = 0; i < 8; ++i) {
            seen.mark = marks[part] + i;
            parts[part] = instances.Match({seen}, {})[0];
            seen.overlaps = {{parts[part], 90}};
        }
    }
    return parts;
}

// Joins the two parts, of which the map shows the fraction `share`.
void Join(Instances& instances, const std::array<InstanceId, 2>& parts, double share) {
    ObservedObject both = Seen(5, {{parts[0], 50}, {parts[1], 48}}, static_cast<int>(55 / share));
    both.mark = 1;
    for (int i = 0; i < 12; ++i) instances.Match({both}, {{parts[0], {55}}, {parts[1], {55}}});
    ASSERT_EQ(instances.Resolve(parts[1]), parts[0]);
}

TEST(InstanceNumbers, WhatWasJoinedIsKnownByTheDetectionsOfBoth) {
    Instances before({.min_observations = 3, .min_rate = 0.3});
    Confirmed(before, 7);
    const auto parts = Parts(before, {100, 200});
    Join(before, parts, 1.0);
    ASSERT_EQ(before.record(parts[0]).public_id, 2);
    // Detections of the part that was merged into the other.
    Instances after = TwoObjects({}, {200, 201, 202}, false);
    after.KeepNumbersOf(before);
    EXPECT_EQ(NumberOfClass(after, 6), 2);
}

TEST(InstanceNumbers, JoinedBeforeTheyAreConfirmedTheyGetTheNumberThatEitherHad) {
    const Instances before = TwoObjects({10, 20, 30}, {200, 201, 202}, false);
    ASSERT_EQ(NumberOfClass(before, 6), 2);
    Instances after({.min_observations = 3, .min_rate = 0.3});
    const auto parts = Parts(after, {100, 200});
    after.KeepNumbersOf(before);
    Join(after, parts, 0.1);
    ASSERT_EQ(after.record(parts[0]).public_id, 0);
    for (int i = 0; i < 40; ++i) after.Match({Seen(5, {{parts[0], 90}})}, {{parts[0], {95}}});
    EXPECT_EQ(after.record(parts[0]).public_id, 2);
}

}  // namespace
}  // namespace tessera
